#include "core/procedural/slab_cuts.h"

#include <cmath>

#include "core/base/portable_math.h"

namespace terrazzo {

using namespace portable;

namespace {

using Polygon = SlabCuts::Polygon;
using Corner = SlabCuts::Corner;

constexpr double cell_size = 2.6;  // side of an uncut cell, in slabs

/// Twice the signed area of the triangle from the origin to an edge.
double cross(const Corner& a, const Corner& b) {
  return a.x * b.y - b.x * a.y;
}

double area(const Polygon& p) {
  double sum = 0;
  for (size_t i = 0; i < p.size(); i++) sum += cross(p[i], p[(i + 1) % p.size()]);
  return sum / 2;
}

Corner centroid(const Polygon& p) {
  double x = 0, y = 0, sum = 0;
  for (size_t i = 0; i < p.size(); i++) {
    const Corner &a = p[i], &b = p[(i + 1) % p.size()];
    const double weight = cross(a, b);
    x += (a.x + b.x) * weight;
    y += (a.y + b.y) * weight;
    sum += weight;
  }
  if (sum == 0) return p.front();
  return {x / (3 * sum), y / (3 * sum)};
}

}  // namespace

SlabCuts::SlabCuts(const Canvas& canvas, double unit, double uneven, uint64_t salt)
    : unit_(unit), uneven_(uneven), cells_(canvas, {unit * cell_size, {0.5, 0.42}, salt}) {
  for (const StonePacking::Stone& stone : cells_.stones()) {
    Dice dice(lattice_bits(canvas.seed() ^ ((salt + 32) * 0x9e3779b97f4a7c15ULL), int64_t(stone.id), 0));
    roots_.push_back(cut(cell_around(stone), dice));
  }
}

Polygon SlabCuts::cell_around(const StonePacking::Stone& stone) const {
  const double far = 1.5 * cell_size * unit_;
  Polygon cell = {{-far, -far}, {far, -far}, {far, far}, {-far, far}};
  cells_.visit_near(stone.x, stone.y, [&](const StonePacking::Stone& s) {
    const double dx = s.x - stone.x, dy = s.y - stone.y, length = std::sqrt(dx * dx + dy * dy);
    if (length == 0) return;
    const double c = (length * length + stone.radius * stone.radius - s.radius * s.radius) / (2 * length);
    cell = before(cell, {dx / length, dy / length, c});
  });
  return cell;
}

Polygon SlabCuts::before(const Polygon& polygon, const Line& line) {
  Polygon kept;
  for (size_t i = 0; i < polygon.size(); i++) {
    const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = line.nx * a.x + line.ny * a.y - line.c, db = line.nx * b.x + line.ny * b.y - line.c;
    if (da <= 0) kept.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
      const double t = da / (da - db);
      kept.push_back({mix(a.x, b.x, t), mix(a.y, b.y, t)});
    }
  }
  return kept;
}

int SlabCuts::cut(const Polygon& polygon, Dice& dice) {
  const double wanted = unit_ * unit_ * (1.5 + 0.9 * uneven_ * dice.both());
  if (area(polygon) <= wanted) return add_slab(polygon);
  const Line line = crack(polygon, dice);
  const Polygon front = before(polygon, line), back = before(polygon, {-line.nx, -line.ny, -line.c});
  if (front.size() < 3 || back.size() < 3) return add_slab(polygon);
  const int at = int(parts_.size());
  parts_.push_back({.line = line});
  const int first = cut(front, dice), second = cut(back, dice);
  parts_[size_t(at)].before = first;
  parts_[size_t(at)].behind = second;
  return at;
}

/// A crack near the middle, across the longer side.
SlabCuts::Line SlabCuts::crack(const Polygon& polygon, Dice& dice) const {
  const Corner middle = centroid(polygon);
  double xx = 0, xy = 0, yy = 0;
  for (const Corner& c : polygon) {
    xx += (c.x - middle.x) * (c.x - middle.x);
    xy += (c.x - middle.x) * (c.y - middle.y);
    yy += (c.y - middle.y) * (c.y - middle.y);
  }
  const double turns = portable::atan2(2 * xy, xx - yy) / 12.566370614359172 + 0.08 * uneven_ * dice.both();
  const double nx = cos_turns(turns), ny = sin_turns(turns);
  const double off = 0.22 * uneven_ * dice.both() * unit_;
  return {nx, ny, nx * middle.x + ny * middle.y + off};
}

int SlabCuts::add_slab(const Polygon& polygon) {
  Slab slab{slabs_.size(), centroid(polygon), {}};
  for (size_t i = 0; i < polygon.size(); i++) {
    const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
    if (length < 1e-9 * unit_) continue;
    slab.edges.push_back({dy / length, -dx / length, (dy * a.x - dx * a.y) / length});
  }
  slabs_.push_back(std::move(slab));
  parts_.push_back({.slab = int(slabs_.size()) - 1});
  return int(parts_.size()) - 1;
}

SlabCuts::Place SlabCuts::at(double u, double v) const {
  const StonePacking::Stone& cell = cells_.owner(u, v);
  const double x = u - cell.x, y = v - cell.y;
  const Part* part = &parts_[size_t(roots_[size_t(cell.id)])];
  while (part->slab < 0) {
    const double ahead = part->line.nx * x + part->line.ny * y - part->line.c;
    part = &parts_[size_t(ahead <= 0 ? part->before : part->behind)];
  }
  const Slab& slab = slabs_[size_t(part->slab)];
  double least = unit_;
  for (const Line& e : slab.edges) least = std::min(least, e.c - e.nx * x - e.ny * y);
  return {slab.id, x - slab.middle.x, y - slab.middle.y, std::max(0.0, least)};
}

}  // namespace terrazzo
