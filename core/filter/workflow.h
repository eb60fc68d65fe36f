#pragma once

#include "core/numeric/eigen.h"

/// Converts between the two PBR workflows, in linear light. Specular: a diffuse and a specular colour. Metallic: a base
/// colour and a metalness; dielectrics have a specular reflectance of 0.04. Follows the appendix of glTF's
/// KHR_materials_pbrSpecularGlossiness (Khronos Group 2017), but with Rec. 709 luminance instead of perceived
/// brightness: luminance is linear, so round trips are exact even for mixed materials. Pure functions.
namespace terrazzo {

inline constexpr double dielectric_specular = 0.04;

struct SpecularColors {
  Vector3d diffuse, specular;  ///< 0..1
};

struct MetallicColors {
  Vector3d base;        ///< 0..1
  double metallic = 0;  ///< 0..1
};

/// Specular luminance up to 0.04 counts as dielectric: darker metals cannot be distinguished.
MetallicColors to_metallic(const SpecularColors& colors);
SpecularColors to_specular(const MetallicColors& colors);

}  // namespace terrazzo
