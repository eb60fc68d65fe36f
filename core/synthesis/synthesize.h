#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "core/base/task.h"
#include "core/exemplar/appearance.h"
#include "core/exemplar/uv_map.h"
#include "core/synthesis/state/control.h"
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

/// Synthesizes a uv map coarse to fine (Lefebvre & Hoppe 2005 and 2006): random blocks of the exemplar at the coarsest
/// level, then per level upsampling, jitter and correction passes, most of them where pixels are few. The result is a
/// function of the index and the options alone. What an index of streaks is made of (Repeats::streaks) is made as much
/// shorter, and then drawn out to its length. Throws Cancelled, and Error if a control does not suit.
UvMapPtr synthesize(const Index& index, const SynthesisOptions& options, const Task& task);

/// The same in two steps, so that parts of a surface can be made apart from one another, by any number of machines.
///
/// The coarse levels of the whole surface: all that depends on the surface as a whole. A uv map of the surface's size
/// divided by 2, rounded up: each of its pixels stands for a block of 2x2 pixels of the next finer level, and tells the
/// exemplar pixel of that level which the block's first pixel begins with. Throws as synthesize does.
UvMapPtr coarse_uv(const Index& index, const SynthesisOptions& options, const Task& task);

/// The size of that uv map; `levels`: of the exemplar.
Size coarse_size(Size surface, int levels);
/// Throws Error about "coarse" if coarse levels of size `found` are not of the surface, whose are `expected`.
void require_coarse_size(Size surface, Size expected, Size found);

/// A part of what synthesize() gives, to the bit: `region` of the surface, which may hang over the right and the bottom
/// border where it tiles. `coarse` must come from coarse_uv() with the same index and options. The finest level is
/// worked out for the region and an apron around it, as wide as its corrections look. Throws Cancelled, and Error about
/// "coarse" or "origin" if they do not suit.
UvMapPtr refine(const Index& index, const UvMap& coarse, const SynthesisOptions& options, const Rect& region,
                const Task& task);

}  // namespace terrazzo
