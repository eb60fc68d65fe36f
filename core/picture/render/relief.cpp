#include "core/picture/render/relief.h"

#include <algorithm>

namespace terrazzo::render {

namespace {

double surface_at(const Textures& t, double x, double y) {
  return t.height.value(x, y / t.aspect) * t.depth;
}

/// The same for light that reaches a point: the repeat is centred on that point.
double surface_around(const Textures& t, double x, double y, double point_x, double point_y) {
  return t.height_at(x, y / t.aspect, point_x, point_y / t.aspect) * t.depth;
}

/// Enough steps that none is longer than about one texel, within reason.
int step_count(const Textures& t, double length) {
  return std::clamp(int(length * t.height.size().width) + 2, 4, 64);
}

}  // namespace

ReliefPoint visible_point(const Textures& t, double x, double y, const Vector3d& view) {
  if (t.height.empty() || t.depth <= 0) return {x, y, 0};
  const double up = std::max(view.z(), 0.15);
  // Going down by 1 moves the point away from the viewer; v runs downwards.
  const double dx = -view.x() / up, dy = view.y() / up;
  const double travel = std::sqrt(dx * dx + dy * dy) * t.depth;
  if (travel * t.height.size().width < 0.1) return {x, y, surface_around(t, x, y, x, y)};
  const int steps = step_count(t, travel);
  double above = 0, below = t.depth;
  for (int k = 1; k <= steps; k++) {
    const double down = t.depth * k / steps;
    if (surface_at(t, x + dx * down, y + dy * down) >= t.depth - down) {
      below = down;
      break;
    }
    above = down;
  }
  for (int k = 0; k < 5; k++) {
    const double middle = (above + below) / 2;
    (surface_at(t, x + dx * middle, y + dy * middle) >= t.depth - middle ? below : above) = middle;
  }
  return {x + dx * below, y + dy * below, t.depth - below};
}

double light_reaching(const Textures& t, const ReliefPoint& p, const Vector3d& light) {
  if (t.height.empty() || t.depth <= 0) return 1;
  if (light.z() <= 0) return 0;
  const double across = std::sqrt(light.x() * light.x() + light.y() * light.y());
  const double rise = light.z() / std::max(across, 1e-6);
  const double reach = std::min((t.depth - p.z) / rise, 0.25);
  if (reach * t.height.size().width < 0.5) return 1;
  const int steps = step_count(t, reach);
  // The ray starts a little off the surface, so that it is not shaded by its own texel.
  const double bias = 0.35 / t.height.size().width;
  double covered = 0;
  for (int k = 1; k <= steps; k++) {
    const double s = reach * k / steps;
    const double blocker =
        surface_around(t, p.x + light.x() / across * s, p.y - light.y() / across * s, p.x, p.y) - p.z;
    // How far the blocker stands above the ray, as an angle: a light of some width gives a penumbra.
    covered = std::max(covered, (blocker - bias) / s - rise);
  }
  return 1 - std::clamp(covered / 0.12, 0.0, 1.0);
}

}  // namespace terrazzo::render
