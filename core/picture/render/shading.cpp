#include "core/picture/render/shading.h"

#include <algorithm>

namespace terrazzo::render {

namespace {

constexpr double pi = 3.14159265358979324;

Vector3d schlick(const Vector3d& facing, double cosine) {
  const double k = 1 - cosine, k2 = k * k;
  return facing + (Vector3d::Ones() - facing) * (k2 * k2 * k);
}

Vector3d facing_reflectance(const ShadedPoint& p) {
  return Vector3d::Constant(0.04) * (1 - p.metallic) + p.albedo * p.metallic;
}

double width(const ShadedPoint& p) {
  const double r = std::clamp(p.roughness, 0.06, 1.0);
  return r * r;
}

}  // namespace

Vector3d reflected(const ShadedPoint& p, const Vector3d& view, const Vector3d& light) {
  const double nl = p.normal.dot(light);
  if (nl <= 0) return Vector3d::Zero();
  const double nv = std::max(1e-3, p.normal.dot(view));
  const Vector3d half = (view + light).normalized();
  const double nh = std::max(0.0, p.normal.dot(half)), vh = std::max(0.0, view.dot(half));
  const double a = width(p), a2 = a * a;
  const double lobe = nh * nh * (a2 - 1) + 1;
  const double distribution = a2 / (pi * lobe * lobe);
  const double visibility = 0.5 / (nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2));
  const Vector3d fresnel = schlick(facing_reflectance(p), vh);
  const Vector3d diffuse = (1 - p.metallic) * p.albedo.cwiseProduct(Vector3d::Ones() - fresnel);
  return (diffuse + fresnel * (distribution * visibility * pi)) * nl;
}

Vector3d reflected_ambient(const ShadedPoint& p, const Vector3d& view, const Vector3d& up) {
  const double nv = std::clamp(p.normal.dot(view), 0.0, 1.0);
  const Vector3d mirrored = p.normal * (2 * p.normal.dot(view)) - view;
  const auto surroundings = [&](double sky, double sharpness) { return 0.8 + 0.2 * sky * sharpness; };
  // Rough surfaces reflect a blurred environment and lose part of the light between their facets.
  const Vector3d fresnel = schlick(facing_reflectance(p), nv) * (1 - 0.6 * p.roughness);
  const Vector3d diffuse =
      (1 - p.metallic) * p.albedo.cwiseProduct(Vector3d::Ones() - fresnel) * surroundings(p.normal.dot(up), 1);
  return (diffuse + fresnel * surroundings(mirrored.dot(up), 2 * (1 - p.roughness))) * p.occlusion;
}

Vector3d tone_mapped(const Vector3d& color) {
  const auto curve = [](double x) {
    constexpr double knee = 0.75;
    if (x <= knee) return std::max(0.0, x);
    const double over = (x - knee) / (1 - knee);
    return knee + (1 - knee) * over / (1 + over);
  };
  return {curve(color.x()), curve(color.y()), curve(color.z())};
}

}  // namespace terrazzo::render
