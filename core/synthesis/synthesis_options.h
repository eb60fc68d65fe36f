#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/base/geometry.h"
#include "core/synthesis/state/control_map.h"
#include "core/synthesis/state/fixed_pixels.h"

namespace terrazzo {

/// How much work goes into a result: draft is for looking while settings are tried, best is slower than normal.
enum class Quality : uint8_t { draft, normal, best };
inline constexpr std::array<std::string_view, 3> quality_names = {"draft", "normal", "best"};

struct SynthesisOptions {
  Size size;  ///< of the whole surface in pixels, 1..65536 a side
  uint64_t seed = 1;
  bool tile_x = false;  ///< the output wraps around in x
  bool tile_y = false;
  Quality quality = Quality::normal;
  /// Factor on the cost of continuing a neighbour's piece of exemplar; smaller: larger pieces.
  double coherence = 0.7;
  /// Weight of UsagePenalty and ProximityPenalty; 0: parts of the exemplar may be over-used.
  double evenness = 0.7;
  /// Whether bricks and boards of courses are laid whole (lay_courses()), except between kept pixels, and elements that
  /// the analysis knows (lay_elements()). Neither is in drafts or under controls.
  bool whole_bricks = true;
  /// Per level, coarsest first, in that level's exemplar pixels; missing levels have none.
  std::vector<double> jitter{};
  /// What steers the exemplar's parts to their places.
  std::vector<Control> controls{};
  /// Output pixels that are given: those that are always kept stay bit for bit, and the others continue them.
  ExistingPixels kept{};
  /// Where the lattices of an exemplar of several parts (Repeats::parts) start: the output position of the kept pixels'
  /// (0, 0). Other lattices start at random, or as the kept pixels have them.
  std::array<int, 2> origin{};
};

}  // namespace terrazzo
