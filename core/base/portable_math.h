#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

/// Elementary functions that use only additions, multiplications, divisions and square roots, so that results are
/// bit-exact on every machine. Relative errors are below 1e-10 for exp2 and exp, 1e-11 for the logarithms, 1e-9 for
/// pow, roots, sines and angles (portable_math_test.cpp compares them with long doubles). All are pure.
namespace terrazzo::portable {

inline int64_t floor_int(double x) {
  const int64_t i = static_cast<int64_t>(x);
  return i - (x < static_cast<double>(i));
}

/// 2^x for x in [-1000, 1000].
inline double exp2(double x) {
  const double whole = static_cast<double>(floor_int(x + 0.5));
  const double t = (x - whole) * 0.69314718055994531;
  double sum = 1;
  for (int n = 9; n >= 1; n--) sum = 1 + sum * t / n;
  const uint64_t exponent = static_cast<uint64_t>(static_cast<int64_t>(whole) + 1023) << 52;
  return sum * std::bit_cast<double>(exponent);
}

/// The logarithm to base 2 of a normal number above 0.
inline double log2(double x) {
  const uint64_t bits = std::bit_cast<uint64_t>(x);
  int64_t exponent = static_cast<int64_t>(bits >> 52) - 1023;
  double m = std::bit_cast<double>((bits & 0xfffffffffffffULL) | 0x3ff0000000000000ULL);
  if (m > 1.4142135623730951) {
    m *= 0.5;
    exponent++;
  }
  const double z = (m - 1) / (m + 1), z2 = z * z;
  double sum = 0;
  for (int n = 13; n >= 1; n -= 2) sum = sum * z2 + 1.0 / n;
  return static_cast<double>(exponent) + 2 * z * sum * 1.4426950408889634;
}

/// The natural logarithm of a normal number above 0.
inline double log(double x) {
  return log2(x) * 0.69314718055994531;
}

inline double exp(double x) {
  return exp2(std::clamp(x, -600.0, 600.0) * 1.4426950408889634);
}

/// x^p for x >= 0.
inline double pow(double x, double p) {
  return x <= 0x1p-1000 ? 0 : exp2(std::clamp(p * log2(x), -1000.0, 1000.0));
}

/// x^(1/n) for x > 0: a first guess from the exponent bits, within 7 %, then two steps of Halley's method, each of
/// which triples the correct digits.
template <int n>
double root(double x) {
  constexpr int64_t one = 0x3ff0000000000000;
  double y = std::bit_cast<double>((std::bit_cast<int64_t>(x) - one) / n + one);
  for (int i = 0; i < 2; i++) {
    double power = y;
    for (int k = 1; k < n; k++) power *= y;
    y = y * ((n - 1) * power + (n + 1) * x) / ((n + 1) * power + (n - 1) * x);
  }
  return y;
}

/// The sine of an angle in turns (1 = a full circle).
inline double sin_turns(double turns) {
  double t = turns - static_cast<double>(floor_int(turns + 0.5));  // [-0.5, 0.5)
  if (t > 0.25) t = 0.5 - t;
  if (t < -0.25) t = -0.5 - t;
  const double a = t * 6.2831853071795865, a2 = a * a;
  double sum = 1;
  for (int n = 14; n >= 2; n -= 2) sum = 1 - sum * a2 / (n * (n + 1.0));
  return a * sum;
}

inline double cos_turns(double turns) {
  return sin_turns(turns + 0.25);
}

/// The angle of the direction (x, y) in (-pi, pi], counter-clockwise from x; 0 for (0, 0).
inline double atan2(double y, double x) {
  constexpr double pi = 3.14159265358979324;
  if (x == 0 && y == 0) return 0;
  // The tangents of half and a quarter of the angle to the x axis: the series converges fast for small angles.
  const double t = std::abs(y) / (std::sqrt(x * x + y * y) + std::abs(x));
  const double q = t / (1 + std::sqrt(1 + t * t)), q2 = q * q;
  double sum = 0;
  for (int n = 21; n >= 1; n -= 2) sum = 1.0 / n - q2 * sum;
  const double angle = x < 0 ? pi - 4 * q * sum : 4 * q * sum;
  return y < 0 ? -angle : angle;
}

inline double saturate(double x) {
  return std::clamp(x, 0.0, 1.0);
}

inline double mix(double a, double b, double t) {
  return a + (b - a) * t;
}

/// 0 below `low`, 1 above `high`, a smooth cubic between; `high` may be the smaller one.
inline double smoothstep(double low, double high, double x) {
  const double t = saturate((x - low) / (high - low));
  return t * t * (3 - 2 * t);
}

}  // namespace terrazzo::portable
