#pragma once

#include <array>
#include <cmath>

#include "core/base/portable_math.h"

/// The sRGB transfer function (IEC 61966-2-1), extended to negative values as an odd function; bit-exact on every
/// machine. For finite values; relative error below 1e-9. Thread-safe.
namespace terrazzo {

inline double decode_srgb(double encoded) {
  const double size = std::fabs(encoded);
  if (size <= 0.04045) return encoded / 12.92;
  const double x = (size + 0.055) / 1.055, fifth = portable::root<5>(x);
  return std::copysign(x * x * fifth * fifth, encoded);  // x^2.4
}

inline double encode_srgb(double linear) {
  const double size = std::fabs(linear);
  if (size <= 0.0031308) return linear * 12.92;
  return std::copysign(1.055 * std::sqrt(std::sqrt(size) * portable::root<3>(size)) - 0.055, linear);  // x^(5/12)
}

/// The decoded values of all bytes: most decoded values come from 8-bit files.
const std::array<double, 256>& srgb_of_bytes();

/// The same for one channel of a pixel, faster for values from 8-bit files.
inline double decode_srgb(float encoded) {
  if (encoded >= 0 && encoded <= 1) {
    const int byte = int(encoded * 255 + 0.5f);
    if (float(byte) / 255 == encoded) return srgb_of_bytes()[size_t(byte)];
  }
  return decode_srgb(double(encoded));
}

}  // namespace terrazzo
