#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/numeric/grid_cut.h"
#include "core/synthesis/state/correction_level.h"

namespace terrazzo {

inline constexpr int64_t mismatch_unit = 16;  ///< mismatches are integers of this part of a unit of appearance space

/// What all expansions on one field share. Those whose pixels do not meet can work at the same time.
struct ExpansionGround {
  static constexpr int untouched = -1, kept = -2;

  ExpansionGround(Field& f, const CorrectionLevel& l, int b = 1, bool edges_hide = false)
      : field(f), level(l), block(b), along_edges(edges_hide), node(f.pixels.size(), untouched) {
    if (along_edges) find_edges();
  }

  /// How much shows where a pixel shows a and its neighbour on that side (of field.h) b: 0 if b continues
  /// a, as the exemplar's last pixel is continued by itself.
  int64_t mismatch(ExemplarPixel a, ExemplarPixel b, int side) const;

  /// Whether controls are less content with an exemplar pixel than with the one that a pixel shows.
  bool strays(int pixel, ExemplarPixel offered) const {
    return level.control != nullptr && control_cost(pixel, offered) > control_cost(pixel, field.pixels[size_t(pixel)]);
  }

  Field& field;
  const CorrectionLevel& level;
  int block;         ///< a pixel of the field stands for `block` x `block` pixels of the level
  bool along_edges;  ///< whether what differs shows less along an edge
  /// What it costs each pixel to show what it shows, whatever its neighbours do; empty: nothing.
  std::vector<int32_t> pressure{};
  std::vector<int> node;  ///< of each pixel in its expansion's graph

 private:
  void find_edges();
  /// What showing the exemplar pixel, or a block of them, costs.
  uint64_t control_cost(int pixel, ExemplarPixel shown) const;
  /// How much an exemplar pixel differs from the one a step away.
  double edge_at(const AppearanceVector* v, ptrdiff_t step) const;
  bool continues(ExemplarPixel a, ExemplarPixel b, int side) const;
  /// The k-th of a block's pixels along one of its sides.
  const AppearanceVector* on_side(ExemplarPixel p, int dx, int dy, int k) const;

  std::array<std::vector<float>, 2> edges_;  // to the right and downwards, as the exemplar's pixels lie in memory
};

/// One expansion move (Boykov, Veksler & Zabih 2001; for textures Kwatra et al. 2003): some pixels may come to show
/// something else, and of all subsets that may the one is taken that lowers the mismatch summed along all seams most.
/// Not thread-safe.
class Expansion {
 public:
  explicit Expansion(ExpansionGround& ground) : ground_(ground) {}

  /// Keeps a pixel from what is offered.
  void keep(int pixel);
  /// Offers a pixel something else to show, under that pressure. False if it has been offered already, or stays as it
  /// is.
  bool offer(int pixel, ExemplarPixel shown, int32_t pressure = 0);
  /// Makes the move and forgets what was offered.
  void apply();

 private:
  struct Free {
    int pixel;
    ExemplarPixel offered;
    int32_t pressure;
  };
  void connect(int n);

  ExpansionGround& ground_;
  std::vector<Free> free_;
  std::vector<int> kept_;
  GridCut cut_;
};

}  // namespace terrazzo
