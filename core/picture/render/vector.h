#pragma once

#include <cmath>

/// A three-vector of doubles: directions in a frame of x right, y up, z towards the viewer, or linear colours.
namespace terrazzo::render {

struct Vec {
  double x = 0, y = 0, z = 0;
};
inline Vec operator+(const Vec& a, const Vec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec operator-(const Vec& a, const Vec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec operator*(const Vec& a, double f) {
  return {a.x * f, a.y * f, a.z * f};
}
inline Vec operator*(const Vec& a, const Vec& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
inline double dot(const Vec& a, const Vec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec cross(const Vec& a, const Vec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vec unit(const Vec& a) {
  return a * (1 / std::sqrt(dot(a, a)));
}
inline Vec mix(const Vec& a, const Vec& b, double t) {
  return a * (1 - t) + b * t;
}

}  // namespace terrazzo::render
