#pragma once

#include "core/numeric/eigen.h"

/// Between the two workflows of physically based materials, in linear light. Specular: a diffuse and a specular colour.
/// Metallic: a base colour, and how much of a metal it is; a dielectric reflects 0.04. After the conversion in the
/// appendix of glTF's KHR_materials_pbrSpecularGlossiness (Khronos Group 2017), with Rec. 709's luminance in place of
/// its perceived brightness: luminance is linear, so that the way there and back is exact for mixed materials as well.
/// Pure functions.
namespace terrazzo {

inline constexpr double dielectric_specular = 0.04;

struct SpecularColors {
  Vector3d diffuse, specular;  ///< 0..1
};

struct MetallicColors {
  Vector3d base;        ///< 0..1
  double metallic = 0;  ///< 0..1
};

/// A specular luminance of up to 0.04 is a dielectric's: darker metals cannot be told from one.
MetallicColors to_metallic(const SpecularColors& colors);
SpecularColors to_specular(const MetallicColors& colors);

}  // namespace terrazzo
