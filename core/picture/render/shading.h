#pragma once

#include "core/numeric/eigen.h"

/// Shading of a surface point. Directions are in a frame of x right, y up, z towards the viewer. Colours are linear
/// three-vectors.
namespace terrazzo::render {

struct ShadedPoint {
  Vector3d albedo{0.5, 0.5, 0.5};  ///< linear
  Vector3d normal{0, 0, 1};        ///< unit, in the same frame as the light and view directions
  double roughness = 0.6;          ///< perceptual; its square is the width of the distribution
  double metallic = 0;
  double occlusion = 1;
  Vector3d emission{};  ///< linear
};

/// Light reflected towards `view` from a directional light that gives a facing white diffuse surface the brightness 1.
/// Trowbridge-Reitz distribution (Walter et al., Microfacet models for refraction through rough surfaces, 2007),
/// Smith's height-correlated masking and shadowing (Heitz, Understanding the masking-shadowing function, 2014),
/// Schlick's Fresnel term; Lambertian diffuse.
Vector3d reflected(const ShadedPoint& point, const Vector3d& view, const Vector3d& light);

/// Light reflected from surroundings of brightness 1 that are a little darker towards the ground (`up` is the direction
/// of the sky), dimmed by the occlusion.
Vector3d reflected_ambient(const ShadedPoint& point, const Vector3d& view, const Vector3d& up);

/// Tone mapping: linear up to 0.75, then a shoulder that approaches 1.
Vector3d tone_mapped(const Vector3d& color);

}  // namespace terrazzo::render
