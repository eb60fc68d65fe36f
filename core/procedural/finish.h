#pragma once

#include "core/base/task.h"
#include "core/image/image.h"
#include "core/material/material.h"
#include "core/procedural/surface.h"

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

}  // namespace terrazzo
