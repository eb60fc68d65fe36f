#include "core/picture/render/shading.h"

#include <algorithm>

namespace terrazzo::render {

namespace {

constexpr double pi = 3.14159265358979324;

Vec schlick(const Vec& facing, double cosine) {
  const double k = 1 - cosine, k2 = k * k;
  return facing + (Vec{1, 1, 1} - facing) * (k2 * k2 * k);
}

Vec facing_reflectance(const ShadedPoint& p) {
  return mix(Vec{0.04, 0.04, 0.04}, p.albedo, p.metallic);
}

double width(const ShadedPoint& p) {
  const double r = std::clamp(p.roughness, 0.06, 1.0);
  return r * r;
}

}  // namespace

Vec reflected(const ShadedPoint& p, const Vec& view, const Vec& light) {
  const double nl = dot(p.normal, light);
  if (nl <= 0) return {};
  const double nv = std::max(1e-3, dot(p.normal, view));
  const Vec half = unit(view + light);
  const double nh = std::max(0.0, dot(p.normal, half)), vh = std::max(0.0, dot(view, half));
  const double a = width(p), a2 = a * a;
  const double lobe = nh * nh * (a2 - 1) + 1;
  const double distribution = a2 / (pi * lobe * lobe);
  const double visibility = 0.5 / (nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2));
  const Vec fresnel = schlick(facing_reflectance(p), vh);
  const Vec diffuse = p.albedo * (1 - p.metallic) * (Vec{1, 1, 1} - fresnel);
  return (diffuse + fresnel * (distribution * visibility * pi)) * nl;
}

Vec reflected_ambient(const ShadedPoint& p, const Vec& view, const Vec& up) {
  const double nv = std::clamp(dot(p.normal, view), 0.0, 1.0);
  const Vec mirrored = p.normal * (2 * dot(p.normal, view)) - view;
  const auto surroundings = [&](double sky, double sharpness) { return 0.8 + 0.2 * sky * sharpness; };
  // Rough surfaces mirror a blurred world and lose part of it between their facets.
  const Vec fresnel = schlick(facing_reflectance(p), nv) * (1 - 0.6 * p.roughness);
  const Vec diffuse = p.albedo * (1 - p.metallic) * (Vec{1, 1, 1} - fresnel) * surroundings(dot(p.normal, up), 1);
  return (diffuse + fresnel * surroundings(dot(mirrored, up), 2 * (1 - p.roughness))) * p.occlusion;
}

Vec tone_mapped(const Vec& color) {
  const auto curve = [](double x) {
    constexpr double knee = 0.75;
    if (x <= knee) return std::max(0.0, x);
    const double over = (x - knee) / (1 - knee);
    return knee + (1 - knee) * over / (1 + over);
  };
  return {curve(color.x), curve(color.y), curve(color.z)};
}

}  // namespace terrazzo::render
