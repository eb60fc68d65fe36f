#pragma once

#include "core/picture/render/textures.h"

/// Ray marching through a height field: the visible point of a view ray, and shadows.
namespace terrazzo::render {

/// A point of the surface in widths of the material: x along u, y along v (downwards), z up from the lowest possible
/// height, 0..depth.
struct ReliefPoint {
  double x = 0, y = 0, z = 0;
};

/// Follows a view ray that enters the relief's top at (x, y) (relief ray marching: linear steps, then bisection;
/// Policarpo, Oliveira & Comba 2005). `view`: unit, towards the viewer, in the tangent frame.
ReliefPoint visible_point(const Textures& textures, double x, double y, const Vector3d& view);

/// The fraction of a directional light that reaches the point, 0..1; the relief casts soft shadows.
double light_reaching(const Textures& textures, const ReliefPoint& point, const Vector3d& light);

}  // namespace terrazzo::render
