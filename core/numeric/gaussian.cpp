#include "core/numeric/gaussian.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace terrazzo {

namespace {

/// The quotient of two polynomials, coefficients of the highest powers first.
template <size_t n, size_t m>
double rational(const std::array<double, n>& numerator, const std::array<double, m>& denominator, double x) {
  double above = 0, below = 0;
  for (const double c : numerator) above = above * x + c;
  for (const double c : denominator) below = below * x + c;
  return above / below;
}

}  // namespace

double normal_quantile(double rank) {
  const double q = rank - 0.5;
  if (std::abs(q) <= 0.425)
    return q * rational(std::array{59.109374720, 159.29113202, 50.434271938, 3.3871327179},
                        std::array{67.187563600, 78.757757664, 17.895169469, 1.0}, 0.180625 - q * q);
  const double r = std::sqrt(-portable::log(std::min(rank, 1 - rank)));
  const double size = r <= 5 ? rational(std::array{0.17023821103, 1.3067284816, 2.7568153900, 1.4234372777},
                                        std::array{0.12021132975, 0.73700164250, 1.0}, r - 1.6)
                             : rational(std::array{0.017337203997, 0.42868294337, 3.0812263860, 6.6579051150},
                                        std::array{0.012258202635, 0.24197894225, 1.0}, r - 5);
  return q < 0 ? -size : size;
}

}  // namespace terrazzo
