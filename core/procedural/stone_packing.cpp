#include "core/procedural/stone_packing.h"

#include <cmath>

#include "core/base/portable_math.h"

namespace terrazzo {

using namespace portable;

namespace {

constexpr double bucket_units = 1.6;  // wider than any stone, so that neighbours lie in adjoining buckets
constexpr double margin_units = 3.2;
constexpr double throws_per_disc = 7;  // per disc that would fit: with more, hardly any disc finds a place
constexpr double large_per_disc = 0.45;
constexpr double rounding_units = 0.7;  // borders farther away do not round a corner

}  // namespace

StonePacking::StonePacking(const Canvas& canvas, const PackingSpec& spec)
    : unit_(spec.unit),
      bucket_size_(spec.unit * bucket_units),
      margin_(spec.unit * margin_units),
      columns_(bucket(1) + 3),
      rows_(bucket(canvas.aspect()) + 3),
      buckets_(size_t(columns_ * rows_)) {
  for (size_t k = 0; k < spec.radii.size(); k++) throw_discs(canvas, spec, spec.radii[k] * spec.unit, spec.salt + k);
}

int64_t StonePacking::bucket(double along) const {
  return floor_int((along + margin_) / bucket_size_);
}

void StonePacking::throw_discs(const Canvas& canvas, const PackingSpec& spec, double radius, uint64_t salt) {
  const double around = canvas.wraps() ? 0 : margin_;
  const double width = 1 + 2 * around, height = canvas.aspect() + 2 * around;
  // The smallest discs close all gaps; of the larger ones only so many are thrown that room is left for these.
  const bool last = radius == spec.radii.back() * spec.unit;
  const double discs = std::max(1.0, width / (2 * radius)) * std::max(1.0, height / (2 * radius));
  const int64_t throws = floor_int(1 + discs * (last ? throws_per_disc : large_per_disc));
  for (int64_t n = 0; n < throws; n++) {
    Dice dice(lattice_bits(canvas.seed() ^ (salt * 0x9e3779b97f4a7c15ULL), n, 0));
    const double x = dice.unit() * width - around, y = dice.unit() * height - around;
    if (!fits(x, y, radius)) continue;
    stones_.push_back({x, y, radius, stones_.size()});
    add_copies(canvas, stones_.back());
  }
}

bool StonePacking::fits(double x, double y, double radius) const {
  bool free = true;
  visit_near(x, y, [&](const Stone& s) {
    const double reach = s.radius + radius;
    free = free && (s.x - x) * (s.x - x) + (s.y - y) * (s.y - y) >= reach * reach;
  });
  return free;
}

void StonePacking::add_copies(const Canvas& canvas, const Stone& stone) {
  const int64_t across = canvas.wraps() ? floor_int(margin_) + 1 : 0;
  const int64_t down = canvas.wraps() ? floor_int(margin_ / canvas.aspect()) + 1 : 0;
  for (int64_t j = -down; j <= down; j++)
    for (int64_t i = -across; i <= across; i++) {
      Stone copy = stone;
      copy.x += double(i);
      copy.y += double(j) * canvas.aspect();
      const int64_t column = bucket(copy.x), row = bucket(copy.y);
      if (column < 0 || row < 0 || column >= columns_ || row >= rows_) continue;
      buckets_[size_t(row * columns_ + column)].push_back(copy);
    }
}

const StonePacking::Stone& StonePacking::owner(double u, double v) const {
  const Stone* best = nullptr;
  double least = 0;
  visit_near(u, v, [&](const Stone& s) {
    const double power = (u - s.x) * (u - s.x) + (v - s.y) * (v - s.y) - s.radius * s.radius;
    if (best && power >= least) return;
    best = &s;
    least = power;
  });
  return *best;
}

StonePacking::Place StonePacking::at(double u, double v) const {
  const Stone& own = owner(u, v);
  const double x = u - own.x, y = v - own.y, power = x * x + y * y - own.radius * own.radius;
  const double reach = rounding_units * unit_, far = 1 / (reach * reach);
  double sum = 0;
  visit_near(u, v, [&](const Stone& s) {
    if (&s == &own) return;
    const double dx = u - s.x, dy = v - s.y;
    // The adjoining buckets hold all stones within this distance, but only some of those beyond it.
    if (dx * dx + dy * dy > bucket_size_ * bucket_size_) return;
    const double nx = s.x - own.x, ny = s.y - own.y;
    const double ahead = dx * dx + dy * dy - s.radius * s.radius - power;
    const double border = std::max(1e-4 * unit_, ahead / (2 * std::sqrt(nx * nx + ny * ny)));
    const double near = std::max(0.0, 1 / (border * border) - far);
    sum += near * near;
  });
  // A soft minimum of the distances to all borders rounds the corners.
  return {own.id, x, y, 1 / std::sqrt(std::sqrt(sum) + far)};
}

}  // namespace terrazzo
