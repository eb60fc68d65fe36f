#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/numeric/grid_cut.h"
#include "core/synthesis/state/correction_level.h"

namespace terrazzo {

inline constexpr int64_t mismatch_unit = 16;  ///< mismatches are integers, in so many parts of an appearance unit

/// What all expansions on one field share. Expansions whose pixels do not meet may work on it at the same time.
struct ExpansionProblem {
  static constexpr int untouched = -1, kept = -2;  ///< in `node`

  ExpansionProblem(Field& f, const CorrectionLevel& l, bool edges_hide = false);

  /// How visible the seam is where a pixel shows a and its neighbour on that side (of field.h) shows b: 0 if b
  /// continues a. The exemplar's last pixel is continued by itself.
  int64_t mismatch(ExemplarPixel a, ExemplarPixel b, int side) const;

  Field& field;
  const CorrectionLevel& level;
  const Plane plane;  ///< the field's
  bool along_edges;   ///< whether edges hide mismatch
  /// What it costs each pixel to show what it shows, whatever its neighbours show; empty: nothing.
  std::vector<int32_t> unary_cost{};
  std::vector<int> node;  ///< of each pixel in its expansion's graph

 private:
  void find_edges();
  /// How much an exemplar pixel differs from the one a step away.
  float edge_at(const AppearanceVector* v, ptrdiff_t step) const;
  bool continues(ExemplarPixel a, ExemplarPixel b, int side) const;
  /// The k-th of a block's pixels along its side towards (dx, dy).
  const AppearanceVector* on_side(ExemplarPixel p, int dx, int dy, int k) const;

  float edge_, seen_on_edges_;               // tuning constants, at hand for inner loops
  std::array<std::vector<float>, 2> edges_;  // distances to the right and downwards, laid out as the padded exemplar
};

/// One expansion move (Boykov, Veksler & Zabih 2001; for textures Kwatra et al. 2003): some pixels may come to show
/// something else, and of all subsets of them the one that lowers the mismatch summed along all seams most does.
/// Not thread-safe.
class Expansion {
 public:
  explicit Expansion(ExpansionProblem& problem) : problem_(problem) {}

  /// Excludes a pixel from the move.
  void keep(int pixel);
  /// Offers a pixel something else to show, at that unary cost in parts of an appearance unit. False if it has an offer
  /// already, is excluded, or must not show that (CorrectionLevel::may_change).
  bool offer(int pixel, ExemplarPixel shown, int32_t unary_cost = 0);
  /// Makes the move and forgets what was offered.
  void apply();

 private:
  struct Free {
    int pixel;
    ExemplarPixel offered;
    int32_t unary_cost;
  };
  void connect(int n);

  ExpansionProblem& problem_;
  std::vector<Free> free_;
  std::vector<int> kept_;
  GridCut cut_;
};

}  // namespace terrazzo
