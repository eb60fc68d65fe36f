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
  /// Weight of the usage term; 0: parts of the exemplar may be over-used.
  double evenness = 0.7;
  /// Bricks and boards of an exemplar built of courses are laid whole (lay_courses()), but in drafts, under controls
  /// and between kept pixels; so are elements that the analysis knows (lay_elements()), between kept pixels, too.
  bool whole_bricks = true;
  /// Per level, coarsest first, in that level's exemplar pixels; missing levels have none.
  std::vector<double> jitter{};
  /// What steers the exemplar's parts to their places.
  std::vector<Control> controls{};
  /// Output pixels that are there already: they stay bit for bit, and the others continue them.
  ExistingPixels kept{};
  /// The output position of the kept pixels' (0, 0): where the lattices of an exemplar's parts start. That of a whole
  /// exemplar starts elsewhere with each seed, or where it does in what is kept.
  std::array<int, 2> origin{};
};

}  // namespace terrazzo
