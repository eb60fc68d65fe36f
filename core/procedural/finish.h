#pragma once

#include "core/base/task.h"
#include "core/image/image.h"
#include "core/material/material.h"
#include "core/procedural/surface.h"

/// Parameters for converting a surface to a material's maps.
namespace terrazzo {

struct Finish {
  Size size;
  bool wraps = true;
  double relief = 10;   ///< height difference between 0 and 1 in pixels
  double reach = 40;    ///< radius of occlusion in pixels
  double cavity = 0.3;  ///< how much of the occlusion also darkens the colour
};

/// Samples the surface (four times a pixel), then derives normals and occlusion from the height, and rounds all maps to
/// the steps of their depth.
MaterialPtr finished_material(const std::string& name, const Surface& surface, const Finish& finish, const Task& task);

}  // namespace terrazzo
