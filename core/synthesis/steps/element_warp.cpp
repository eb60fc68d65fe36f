#include "core/synthesis/steps/element_warp.h"

#include <algorithm>
#include <cmath>

#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct ElementWarpTuning {
  double core = 0.4;
  double unseen = 0.75;
  double widest = 1.6;
};
const Tunable<ElementWarpTuning> element_warp_tuning(
    "element_warp", {
                        {&ElementWarpTuning::core, "core", "of the way to the outline",
                         "that stays as it is. Higher: the rim is squeezed more; lower: all of an element is resampled",
                         "element_layout", 0, 0.95},
                        {&ElementWarpTuning::unseen, "unseen", "blocks",
                         "by which neighbours may miss each other without being moved", "element_layout", 0, 100},
                        {&ElementWarpTuning::widest, "widest", "times the way to the outline",
                         "that an element is stretched at most. Higher: gaps are filled with stones rather than joint",
                         "element_layout", 1, 10},
                    });

/// Directions by an angle that needs no trigonometry: 0 to 4 around the square |x| + |y| = 1.
ElementWarp::At direction(double angle) {
  const int quadrant = int(angle) & 3;
  const double t = angle - std::floor(angle);
  switch (quadrant) {
    case 0:
      return {1 - t, t};
    case 1:
      return {-t, 1 - t};
    case 2:
      return {t - 1, -t};
    default:
      return {t, t - 1};
  }
}

double angle_of(double x, double y) {
  if (y >= 0) return x >= 0 ? y / std::max(1e-9, x + y) : 1 - x / (y - x);
  return x < 0 ? 2 + y / (x + y) : 3 + x / (x - y);
}

/// Walks outwards from the centre, a block at a time, until inside(at) is no longer above 0; the crossing is found
/// between steps. 0 if the centre is outside.
template <typename Inside>
double first_crossing(ElementWarp::At along, double farthest, Inside inside) {
  double before = inside(ElementWarp::At{0, 0});
  if (before <= 0) return 0;
  for (double s = 1; s <= farthest; s++) {
    const double now = inside(ElementWarp::At{along.x * s, along.y * s});
    if (now <= 0) return s - 1 + before / std::max(1e-9, before - now);
    before = now;
  }
  return farthest;
}

int nearest(double v) {
  return int(std::floor(v + 0.5));
}

}  // namespace

ElementWarp::ElementWarp(const ElementShapes& shapes, const ElementPacking& packing, int placed) {
  const PlacedElement& p = packing.placed()[size_t(placed)];
  const ElementShape& shape = shapes[p.element];
  const int column = shapes.column_of(p), row = shapes.row_of(p);
  const double farthest = shape.box.width + shape.box.height;
  const auto own = [&](At at) { return shape.depth_between(at.x, at.y); };
  // By how much deeper a place lies in this element than in the next, negative where it belongs to another.
  const auto ahead = [&](At at) -> double {
    const ElementPacking::Place* place = packing.find(column + nearest(at.x), row + nearest(at.y));
    if (!place) return 0;
    const double by = double(place->depth.blocks()) - std::max(-farthest, double(place->neighbour.blocks()));
    return place->placed == placed ? std::max(1e-6, by) : std::min(-1e-6, -by);
  };
  const int count = std::clamp(2 * (shape.box.width + shape.box.height), 64, 2048);
  for (int i = 0; i < count; i++) {
    const At along = direction(4.0 * i / count);
    Ray ray{first_crossing(along, farthest, own), first_crossing(along, farthest, ahead)};
    if (ray.outline <= 0 || ray.border <= 0) {
      rays_.clear();
      return;
    }
    const bool leaves =
        !packing.find(column + nearest(along.x * (ray.border + 1)), row + nearest(along.y * (ray.border + 1)));
    ray.border = leaves ? ray.outline : std::min(ray.border, element_warp_tuning->widest * ray.outline);
    rays_.push_back(ray);
  }
}

ElementWarp::Ray ElementWarp::ray(double angle) const {
  const double at = angle * double(rays_.size()) / 4, part = at - std::floor(at);
  const Ray &a = rays_[size_t(at) % rays_.size()], &b = rays_[(size_t(at) + 1) % rays_.size()];
  return {a.outline + part * (b.outline - a.outline), a.border + part * (b.border - a.border)};
}

ElementWarp::At ElementWarp::operator()(At at) const {
  const double s = std::abs(at.x) + std::abs(at.y);
  if (rays_.empty() || s <= 0) return at;
  const Ray r = ray(angle_of(at.x, at.y));
  if (std::abs(r.outline - r.border) < element_warp_tuning->unseen) return at;
  const double core = element_warp_tuning->core * std::min(r.outline, r.border);
  if (s <= core) return at;
  const double to =
      s < r.border ? core + (s - core) * (r.outline - core) / (r.border - core) : r.outline + s - r.border;
  return {at.x * to / s, at.y * to / s};
}

}  // namespace terrazzo
