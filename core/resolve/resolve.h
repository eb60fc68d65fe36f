#pragma once

#include <array>

#include "core/exemplar/uv_map.h"
#include "core/material/material.h"

namespace terrazzo {

struct ResolveOptions {
  /// Radius of seam blending in pixels of the uv map, 0..largest_blend; 0: every pixel is exactly one exemplar pixel.
  double blend = 0;
  /// How far heights give way so that pieces meet, see core/resolve/joined_heights.h: in pixels of the uv map, or below
  /// 1 as a part of the analysed exemplar's shorter side; 0: not at all. Heights that are joined are not blended.
  double join = 0;
  /// How much larger the exemplar is than the one that was analysed, and the maps than the uv map: 1..largest_scale,
  /// or 0 for whatever the exemplar's size says.
  double scale = 1;
  /// A result whose heights stay as they are where `join` would move them, null if there is none; where its top left
  /// pixel lies, in pixels of the uv map; and an image that is above 0.5 where it does not count, null if it does
  /// everywhere. See core/resolve/kept_heights.h.
  MaterialPtr kept{};
  std::array<int, 2> kept_at{};
  ImagePtr holes{};
};
inline constexpr double largest_blend = 8;
inline constexpr double farthest_join = 1024;
inline constexpr double largest_scale = 64;

/// Whether seams of such a map are blended: not those of masks and data, whose values may be labels.
bool can_blend(Semantic semantic);

/// The maps an output shows, pulled lazily: a map is nothing but uv map and exemplar.
///
/// Without blending each pixel is exactly one exemplar pixel. With it, every pixel q of the uv map within the radius of
/// an output pixel p proposes the exemplar pixel that continues q's piece to p, and p shows their mean, weighted by
/// (1 - (distance / radius)^2)^2: the magnification of Lefebvre & Hoppe (Parallel controllable texture synthesis, 2005)
/// with a wider and smoother kernel. The mean of what is unlike would be flat: so only the pieces' local means are
/// averaged plainly, and the mean of their details gets back the variance that it lost (Heitz & Neyret,
/// High-performance by-example noise using a histogram-preserving blending operator, 2018). Where all proposals are one
/// exemplar pixel, that pixel is shown bit for bit. Proposals beyond an exemplar that does not wrap are left out.
/// Averages are taken in the space of core/image/pixel_space.h: colours in linear light, normals as vectors that get
/// back the length the exemplar's have.
///
/// `exemplar`'s size (that of its largest map) is the analysed exemplar's times `scale`; smaller maps of it are sampled
/// at the same relative place. All maps get the size of the uv map times `scale`. Throws Error if sizes do not fit, or
/// what is kept lacks a map of heights.
MaterialPtr resolved(const Material& exemplar, const UvMapPtr& uv, const ResolveOptions& options = {},
                     const Task& task = {});

}  // namespace terrazzo
