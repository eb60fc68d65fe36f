#pragma once

#include <vector>

#include "core/base/portable_math.h"

namespace terrazzo {

/// exp(-x^2 / (2 sigma^2)).
inline double gaussian(double x, double sigma) {
  return portable::exp(-0.5 * x * x / (sigma * sigma));
}

/// The weights of a Gaussian blur at -reach..reach pixels; they sum to 1.
inline std::vector<float> gaussian_kernel(double sigma, int reach) {
  std::vector<double> weights;
  double sum = 0;
  for (int i = -reach; i <= reach; i++) {
    weights.push_back(gaussian(i, sigma));
    sum += weights.back();
  }
  std::vector<float> out;
  for (const double w : weights) out.push_back(float(w / sum));
  return out;
}

/// The quantile function of the normal distribution with mean 0 and variance 1, for ranks in (0, 1). Relative error
/// below 2e-7 (PPND7 of Wichura, Algorithm AS 241, 1988). The same bits on every machine.
double normal_quantile(double rank);

}  // namespace terrazzo
