#pragma once

#include "core/picture/render/textures.h"

/// Rays through a height field: which point of the surface is seen, and whether light reaches it.
namespace terrazzo::render {

/// A point of the surface in widths of the material: x along u, y along v (downwards), z up from the lowest possible
/// height, 0..depth.
struct ReliefPoint {
  double x = 0, y = 0, z = 0;
};

/// Follows a view ray that enters the relief's top at (x, y) (relief ray marching: linear steps, then bisection;
/// Policarpo, Oliveira & Comba 2005). `view`: unit, towards the viewer, in the tangent frame.
ReliefPoint visible_point(const Textures& textures, double x, double y, const Vector3d& view);

/// The fraction of a directional light that reaches the point past the relief around it, 0..1, with soft edges.
double light_reaching(const Textures& textures, const ReliefPoint& point, const Vector3d& light);

}  // namespace terrazzo::render
