#include "core/node/serialize_check.h"

#include <algorithm>
#include <cmath>

#include "core/block_file/bytes.h"

namespace terrazzo {

namespace {

constexpr int window = 25;           // pixels of a neighbourhood
constexpr int smallest_side = 5;     // one whole neighbourhood
constexpr int largest_side = 65536;  // ExemplarPixel counts no further

bool all_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

void check_level(const AppearanceLevel& level, int channels) {
  require_sound(std::min(level.size.width, level.size.height) >= smallest_side &&
                    std::max(level.size.width, level.size.height) <= largest_side,
                "an exemplar in it is too small or too large");
  const size_t inputs = level.mean.size();
  require_sound(inputs > 0 && inputs % window == 0 && inputs / window <= size_t(channels),
                "a basis in it does not belong to its channels");
  require_sound(all_finite(level.mean) && all_finite(level.basis),
                "a basis in it holds something that is not a number");
  require_sound(level.scale > 0, "a scale in it is not positive");
}

void check_lattice(const Lattice& lattice) {
  for (const double v : {lattice.first.x(), lattice.first.y(), lattice.second.x(), lattice.second.y()})
    require_sound(std::abs(v) <= largest_side, "a lattice in it is larger than any exemplar");
}

bool is_inside(const Rect& r, Size size) {
  const auto fits = [](int first, int length, int all) {
    return first >= 0 && length > 0 && length <= all && first <= all - length;
  };
  return fits(r.x, r.width, size.width) && fits(r.y, r.height, size.height);
}

}  // namespace

void require_sound(bool condition, const char* otherwise) {
  if (!condition) throw DamagedFile(otherwise);
}

void check_levels(const std::vector<AppearanceLevel>& levels, int channels) {
  for (size_t i = 0; i < levels.size(); i++) {
    check_level(levels[i], channels);
    if (i == 0) continue;
    const Size finer = levels[i - 1].size;
    require_sound(levels[i].size == Size{(finer.width + 1) / 2, (finer.height + 1) / 2},
                  "a level in it does not have half the size of the one before");
  }
}

void check_repeats(const Repeats& repeats, Size exemplar) {
  check_lattice(repeats.lattice);
  require_sound(repeats.streaks.is_valid() && (!repeats.streaks.any() || repeats.parts.empty()),
                "the streaks in it are impossible");
  for (const LatticePart& p : repeats.parts) {
    check_lattice(p.lattice);
    check_lattice(p.shown);
    require_sound(p.lattice.rank == p.shown.rank, "a part of it repeats in another way than it is shown");
    require_sound(is_inside(p.place, exemplar), "a part of it lies outside the exemplar");
    require_sound(p.start.lpNorm<Eigen::Infinity>() <= largest_side, "a part of it starts too far away");
  }
}

}  // namespace terrazzo
