#pragma once

#include <array>
#include <map>
#include <string>

#include "core/exemplar/uv_map.h"
#include "core/material/material.h"
#include "core/resolve/slow_tones.h"

namespace terrazzo {

struct ResolveOptions {
  /// Radius of seam blending in pixels of the uv map, 0..largest_blend; 0: every pixel is exactly one exemplar pixel.
  double blend = 0;
  /// The distance from seams within which heights are corrected so that pieces meet (core/resolve/joined_heights.h): in
  /// pixels of the uv map, or below 1 as a fraction of the analysed exemplar's shorter side; 0: off. Joined heights are
  /// not blended.
  double join = 0;
  /// The maps whose slow tones are joined (core/resolve/joined_tones.h), by name; see slow_tones().
  std::map<std::string, SlowTonesPtr> tones{};
  /// The size of the exemplar relative to the analysed one, and of the maps relative to the uv map: 1..largest_scale,
  /// or 0 to derive it from the exemplar's size.
  double scale = 1;
  /// An earlier result whose pixels joining must not change, or null; the position of its top left pixel, in pixels of
  /// the uv map; and a mask, above 0.5 where it does not count, or null. See core/resolve/kept_pixels.h.
  MaterialPtr kept{};
  std::array<int, 2> kept_at{};
  ImagePtr holes{};
};
inline constexpr double largest_blend = 8;
inline constexpr double farthest_join = 1024;
inline constexpr double largest_scale = 64;

/// Whether maps of this semantic can be blended: not masks and data, whose values may be labels.
bool can_blend(Semantic semantic);

/// The maps of an exemplar whose tones are slow, and those tones. `reach`: below 1 a share of the exemplar's shorter
/// side, else pixels of the uv map; 0: none. Throws Cancelled.
std::map<std::string, SlowTonesPtr> slow_tones(const Material& exemplar, const UvMap& uv, double reach,
                                               const Task& task = {});

/// Resolves a uv map: the maps of the output, computed on demand from the exemplar.
///
/// Without blending each pixel is exactly one exemplar pixel. With it, every pixel q of the uv map within the radius of
/// an output pixel p proposes the exemplar pixel that continues q's piece to p, and p shows their mean with weights (1
/// - (distance / radius)^2)^2: the magnification of Lefebvre & Hoppe (Parallel controllable texture synthesis, 2005)
/// with a wider and smoother kernel. To keep contrast, local means are averaged and the variance of the averaged
/// details is restored (Heitz & Neyret, High-performance by-example noise using a histogram-preserving blending
/// operator, 2018). If all proposals are the same exemplar pixel, it is copied bit for bit. Proposals outside an
/// exemplar that does not wrap are ignored. Averages are taken in the space of core/image/pixel_space.h: colours in
/// linear light, normals as vectors that keep the exemplar's length.
///
/// `exemplar`'s size (that of its largest map) must be the analysed exemplar's times `scale`; smaller maps are sampled
/// at the same relative position. All maps get the uv map's size times `scale`. Throws Error if sizes do not fit, or
/// `kept` lacks a map to be joined; Cancelled.
MaterialPtr resolved(const Material& exemplar, const UvMapPtr& uv, const ResolveOptions& options = {},
                     const Task& task = {});

/// Throws Error about "material" unless an exemplar of that size is the `analysed` one at that scale; 0: at any.
void require_scale(Size exemplar, Size analysed, double scale);
/// The size of all maps resolved through a uv map for the `analysed` exemplar.
Size resolved_size(Size uv, Size analysed, Size exemplar);

}  // namespace terrazzo
