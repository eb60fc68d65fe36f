#pragma once

/// Eigen, configured so that results are bit-exact on every machine. Include this header (or linear_algebra.h for
/// decompositions), never Eigen's own. - Nothing is vectorized or parallelized by Eigen, so sums have one order
/// whatever the processor offers. (The whole
///   library is compiled without contraction into fused multiply-adds.)
/// - Products of large dynamic matrices are summed in blocks whose size depends on the processor's caches. So they are
///   avoided: use fixed sizes, matrices times vectors, or lazyProduct(). Decompositions that need them go through
///   linear_algebra.h, which fixes the sizes of the caches.
/// - Of Eigen's functions, those that call the C library's trigonometric functions are not used (geometry's angles,
///   SelfAdjointEigenSolver::computeDirect); square roots are exact everywhere.
/// Vectors and matrices start as zeros.
#ifdef EIGEN_CORE_H
#error "include core/numeric/eigen.h in place of Eigen's headers"
#endif
#define EIGEN_DONT_VECTORIZE
#define EIGEN_DONT_PARALLELIZE
#define EIGEN_MPL2_ONLY
#define EIGEN_INITIALIZE_MATRICES_BY_ZERO
#include <Eigen/Core>

namespace terrazzo {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::VectorXd;

/// The signed area spanned by two vectors: positive if `b` is counter-clockwise of `a`.
inline double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace terrazzo
