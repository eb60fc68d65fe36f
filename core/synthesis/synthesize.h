#pragma once

#include "core/base/task.h"
#include "core/exemplar/appearance.h"
#include "core/exemplar/uv_map.h"
#include "core/synthesis/synthesis_options.h"

namespace terrazzo {

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
