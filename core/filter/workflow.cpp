#include "core/filter/workflow.h"

#include <algorithm>
#include <cmath>

#include "core/filter/linear_colors.h"

namespace terrazzo {

namespace {

/// Keeps divisions finite by the diffuse part of a pure metal and by the specular part of a pure dielectric.
constexpr double least_part = 1e-6;

double luminance_of(const Vector3d& color) {
  return luminance(color.x(), color.y(), color.z());
}

Vector3d clamped(const Vector3d& color) {
  return {std::clamp(color.x(), 0.0, 1.0), std::clamp(color.y(), 0.0, 1.0), std::clamp(color.z(), 0.0, 1.0)};
}

double largest(const Vector3d& color) {
  return std::max({color.x(), color.y(), color.z()});
}

/// The metallic m of a base colour B with B (1 - m) = diffuse and 0.04 (1 - m) + B m = specular.
double solved_metallic(double diffuse, double specular) {
  const double f0 = dielectric_specular;
  if (specular <= f0) return 0;
  const double b = diffuse + specular - 2 * f0, c = f0 - specular;
  const double root = std::sqrt(std::max(0.0, b * b - 4 * f0 * c));
  return std::clamp((root - b) / (2 * f0), 0.0, 1.0);
}

}  // namespace

MetallicColors to_metallic(const SpecularColors& colors) {
  const double f0 = dielectric_specular;
  // The base colour of a dielectric with the same diffuse light.
  const Vector3d diffuse = colors.diffuse * ((1 - largest(colors.specular)) / (1 - f0));
  const double m = solved_metallic(luminance_of(diffuse), luminance_of(colors.specular));
  const Vector3d of_diffuse = diffuse / std::max(1 - m, least_part);
  const Vector3d of_specular = (colors.specular - Vector3d(1, 1, 1) * (f0 * (1 - m))) / std::max(m, least_part);
  return {clamped(of_diffuse + (of_specular - of_diffuse) * (m * m)), m};
}

SpecularColors to_specular(const MetallicColors& colors) {
  const double f0 = dielectric_specular, m = colors.metallic;
  const Vector3d specular = Vector3d(1, 1, 1) * (f0 * (1 - m)) + colors.base * m;
  const double left = 1 - largest(specular);
  const Vector3d diffuse = left < least_part ? Vector3d(0, 0, 0) : Vector3d(colors.base * ((1 - f0) * (1 - m) / left));
  return {clamped(diffuse), clamped(specular)};
}

}  // namespace terrazzo
