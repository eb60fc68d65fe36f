#include "core/serialize_check.h"

#include <algorithm>
#include <cmath>

#include "core/bytes.h"

namespace terrazzo {

namespace {

constexpr int window = 25;           // pixels of a neighbourhood
constexpr int smallest_side = 5;     // one whole neighbourhood
constexpr int largest_side = 65536;  // ExemplarPixel counts no further

void require(bool condition, const char* otherwise) {
  if (!condition) throw DamagedFile(otherwise);
}

bool all_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

void check_level(const AppearanceLevel& level, int channels) {
  require(std::min(level.size.width, level.size.height) >= smallest_side &&
              std::max(level.size.width, level.size.height) <= largest_side,
          "an exemplar in it is too small or too large");
  const size_t inputs = level.mean.size();
  require(inputs > 0 && inputs % window == 0 && inputs / window <= size_t(channels),
          "a basis in it does not belong to its channels");
  require(all_finite(level.mean) && all_finite(level.basis), "a basis in it holds something that is not a number");
  require(level.scale > 0, "a scale in it is not positive");
}

}  // namespace

void check_levels(const std::vector<AppearanceLevel>& levels, int channels, const Lattice& lattice) {
  for (size_t i = 0; i < levels.size(); i++) {
    check_level(levels[i], channels);
    if (i == 0) continue;
    const Size finer = levels[i - 1].size;
    require(levels[i].size == Size{(finer.width + 1) / 2, (finer.height + 1) / 2},
            "a level in it does not have half the size of the one before");
  }
  for (const double v : {lattice.first.x, lattice.first.y, lattice.second.x, lattice.second.y})
    require(std::abs(v) <= largest_side, "a lattice in it is larger than any exemplar");
}

}  // namespace terrazzo
