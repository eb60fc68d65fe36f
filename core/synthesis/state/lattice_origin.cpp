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

double fraction(double cells) {
  return cells - std::floor(cells);
}

/// Where within a cell output places less exemplar places lie, as a histogram.
class PhaseVotes {
 public:
  explicit PhaseVotes(const Lattice& lattice)
      : lattice_(lattice), rows_(lattice.rank == 2 ? bins : 1), votes_(size_t(bins) * size_t(rows_)) {}

  void add(double x, double y) {
    const Vector2d c = lattice_.cells({x, y}), within{fraction(c.x()), rows_ > 1 ? fraction(c.y()) : 0};
    Votes& v = at(bin_of(within.x()), bin_of(within.y()));
    v.count++;
    v.sum += within;
  }

  /// The mean of the bins, next to one another, that have the most.
  Vector2d most() {
    Votes best;
    for (int row = 0; row < rows_; row++)
      for (int column = 0; column < bins; column++)
        if (const Votes sum = around(column, row); sum.count > best.count) best = sum;
    return lattice_.at(best.sum / double(std::max<int64_t>(1, best.count)));
  }

 private:
  struct Votes {
    int64_t count = 0;
    Vector2d sum{0, 0};  // in cells
  };
  int bin_of(double cells) const { return std::min(bins - 1, int(cells * bins)); }
  Votes& at(int column, int row) { return votes_[size_t(wrap(row, rows_)) * bins + size_t(wrap(column, bins))]; }

  Votes around(int column, int row) {
    const int reach = rows_ > 1 ? 1 : 0;
    Votes sum;
    for (int y = row - reach; y <= row + reach; y++)
      for (int x = column - 1; x <= column + 1; x++) {
        const Votes& v = at(x, y);
        sum.count += v.count;
        // Beyond the border a cell further.
        sum.sum += v.sum + double(v.count) * Vector2d(x < 0 ? -1 : x >= bins ? 1 : 0, y < 0 ? -1 : y >= rows_ ? 1 : 0);
      }
    return sum;
  }

  const Lattice& lattice_;
  int rows_;
  std::vector<Votes> votes_;
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
  PhaseVotes votes(lattice);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const size_t i = size_t(y) * size_t(size.width) + size_t(x);
      if (kept.keep[i] != (some_stay ? Keep::always : Keep::at_first)) continue;
      const ExemplarPixel& p = kept.pixels[i];
      votes.add(x - p.x, y - p.y);
    }
  const Vector2d at = votes.most();
  return lattice.rank == 2 && lattice.is_whole() ? Vector2d{std::floor(at.x() + 0.5), std::floor(at.y() + 0.5)} : at;
}

}  // namespace terrazzo
