#pragma once

#include "core/image.h"
#include "core/material.h"
#include "core/procedural/surface.h"
#include "core/task.h"

/// From a described surface to a material's maps.
namespace terrazzo {

struct Finish {
  Size size;
  bool wraps = true;
  double relief = 10;   ///< pixels between heights 0 and 1
  double reach = 40;    ///< pixels from which neighbours can still shade a point
  double cavity = 0.3;  ///< how much of the occlusion also darkens the colour
};

/// Samples the surface (four times a pixel), then derives normals and occlusion from the height, and rounds all maps to
/// the steps of their depth.
MaterialPtr finished_material(const std::string& name, const Surface& surface, const Finish& finish, const Task& task);

/// The fraction of the sky that each pixel of a height field sees, cosine weighted, from the horizon in 16 directions
/// (after Bavoil et al., Image-space horizon-based ambient occlusion, 2008). `relief`: pixels per unit of height.
std::vector<float> horizon_occlusion(const std::vector<float>& height, Size size, bool wraps, double relief,
                                     double reach, const Task& task);

/// Encoded tangent-space normals, green up, from central differences of a height field.
std::vector<float> normals_of(const std::vector<float>& height, Size size, bool wraps, double relief);

}  // namespace terrazzo
