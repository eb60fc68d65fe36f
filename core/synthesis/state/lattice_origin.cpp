#include "core/synthesis/state/lattice_origin.h"

#include <algorithm>
#include <cmath>

#include "core/base/hash.h"
#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct LatticeOriginTuning {
  int grain = 8;
};
const Tunable<LatticeOriginTuning> lattice_origin_tuning(
    "lattice_origin", {{&LatticeOriginTuning::grain, "grain", "pixels",
                        "of which a lattice's start is a multiple. Higher: coarse levels are "
                        "in phase to the pixel; lower: more seeds differ",
                        "regularity", 1, 1024}});

constexpr int bins = 64;

/// Places within a cell that fall into one bin.
struct Votes {
  int64_t count = 0;
  Vector2d sum{0, 0};  // in cells
};

}  // namespace

Vector2d random_lattice_origin(const Lattice& lattice, uint64_t bits) {
  if (lattice.rank == 0) return {};
  constexpr uint32_t range = 4096;
  const int grain = lattice_origin_tuning->grain;
  return {double(below(uint32_t(bits), range / uint32_t(grain)) * uint32_t(grain)),
          double(below(uint32_t(bits >> 32), range / uint32_t(grain)) * uint32_t(grain))};
}

Vector2d lattice_origin(const Lattice& lattice, const ExistingPixels& kept, Size size) {
  if (lattice.rank == 0) return {};
  const bool some_stay = std::ranges::find(kept.keep, Keep::always) != kept.keep.end();
  const int rows = lattice.rank == 2 ? bins : 1;
  std::vector<Votes> votes(size_t(bins) * size_t(rows));
  const auto bin_of = [](double part, int count) { return size_t(std::min(count - 1, int(part * count))); };
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const size_t i = size_t(y) * size_t(size.width) + size_t(x);
      if (kept.keep[i] != (some_stay ? Keep::always : Keep::at_first)) continue;
      const ExemplarPixel& p = kept.pixels[i];
      const Vector2d cells = lattice.cells({double(x - p.x), double(y - p.y)});
      const Vector2d within = cells.array() - cells.array().floor();
      Votes& v = votes[bin_of(within.y(), rows) * bins + bin_of(within.x(), bins)];
      v.count++;
      v.sum += within;
    }
  const Votes& most = *std::ranges::max_element(votes, {}, &Votes::count);
  const Vector2d at = lattice.at(most.sum / double(std::max<int64_t>(1, most.count)));
  return lattice.rank == 2 && lattice.is_whole() ? Vector2d{std::floor(at.x() + 0.5), std::floor(at.y() + 0.5)} : at;
}

}  // namespace terrazzo
