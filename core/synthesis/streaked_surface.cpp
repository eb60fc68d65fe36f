#include "core/synthesis/streaked_surface.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "core/base/hash.h"
#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct StreakedSurfaceTuning {
  double coherence = 0.4;
};
const Tunable<StreakedSurfaceTuning> streaked_surface_tuning(
    "streaked_surface", {{&StreakedSurfaceTuning::coherence, "coherence", "factor on the cost of continuing a piece",
                          "of streaks. Higher: more of them end, and short ones look like crumbs; lower: streaks "
                          "are copied many side by side, and end along upright seams",
                          "streaks", 0, 1}});

}  // namespace

/// The axis that streaks lie along, and the steps of it that a region needs.
struct StreakedSurface::Axis {
  bool x;         ///< or y
  int step;       ///< pixels that are synthesized as one
  int steps;      ///< of the whole surface
  bool tiles;     ///< the surface, along it
  int first = 0;  ///< step that is held
  int held = 0;   ///< steps

  /// The place of a step among those that are held; nothing if it lies outside.
  std::optional<int> place(int s) const {
    if (s < 0 && !tiles) return std::nullopt;
    return wrap(s - first, steps);
  }
};

StreakedSurface::StreakedSurface(const Appearance& appearance, const SynthesisOptions& options)
    : options_(options),
      streaks_(appearance.repeats().streaks),
      exemplar_(appearance.size()),
      wraps_(appearance.wraps()) {
  if (!streaks_.any()) return;
  ExistingPixels kept = shortened_kept();
  shortened_ = {.size = streaks_.covering(options.size),
                .seed = options.seed,
                .tile_x = options.tile_x,
                .tile_y = options.tile_y,
                .quality = options.quality,
                .coherence = options.coherence * streaked_surface_tuning->coherence,
                .evenness = options.evenness,
                .whole_bricks = options.whole_bricks,
                .jitter = options.jitter,
                .controls = options.controls,
                .kept = std::move(kept),
                .origin = {options.origin[0] / streaks_.x, options.origin[1] / streaks_.y}};
}

ExemplarPixel StreakedSurface::shortened(ExemplarPixel p) const {
  const Size most = streaks_.shortened(exemplar_);
  return {uint16_t(std::min(p.x / streaks_.x, most.width - 1)), uint16_t(std::min(p.y / streaks_.y, most.height - 1))};
}

/// A step is kept as long as each of its pixels; the one in its middle stands for it.
ExistingPixels StreakedSurface::shortened_kept() const {
  if (options_.kept.empty()) return {};
  const Size from = options_.size, to = streaks_.covering(from);
  ExistingPixels kept;
  kept.keep.assign(size_t(to.area()), Keep::always);
  for (int y = 0; y < from.height; y++)
    for (int x = 0; x < from.width; x++) {
      Keep& keep = kept.keep[size_t(y / streaks_.y) * to.width + x / streaks_.x];
      keep = std::min(keep, options_.kept.keep[size_t(y) * from.width + x]);
    }
  for (int y = 0; y < to.height; y++)
    for (int x = 0; x < to.width; x++) {
      const int u = std::min(x * streaks_.x + streaks_.x / 2, from.width - 1);
      const int v = std::min(y * streaks_.y + streaks_.y / 2, from.height - 1);
      kept.pixels.push_back(shortened(options_.kept.pixels[size_t(v) * from.width + u]));
    }
  return kept;
}

StreakedSurface::Axis StreakedSurface::along(const Rect& region) const {
  const bool x = streaks_.x > 1;
  const Size covering = streaks_.covering(options_.size);
  Axis a{x, x ? streaks_.x : streaks_.y, x ? covering.width : covering.height, x ? options_.tile_x : options_.tile_y};
  const int begin = x ? region.x : region.y, end = x ? region.right() : region.bottom();
  const int side = x ? options_.size.width : options_.size.height;
  // The step before the first may be continued into it.
  const int from = begin / a.step - 1;
  const int to = end <= side ? (end + a.step - 1) / a.step : a.steps + (end - side + a.step - 1) / a.step;
  a.first = from >= 0 ? from : a.tiles ? a.steps - 1 : 0;
  a.held = to - from - (from < 0 && !a.tiles ? 1 : 0);
  if (a.held < a.steps) return a;
  a.first = 0;
  a.held = a.steps;
  return a;
}

Rect StreakedSurface::shortened(const Rect& region) const {
  if (!streaks_.any()) return region;
  const Axis a = along(region);
  return a.x ? Rect{a.first, region.y, a.held, region.height} : Rect{region.x, a.first, region.width, a.held};
}

std::optional<ExemplarPixel> StreakedSurface::along_streak(const Axis& a, ExemplarPixel p, int by) const {
  const int side = a.x ? exemplar_.width : exemplar_.height;
  const int v = (a.x ? p.x : p.y) + by;
  if ((v < 0 || v >= side) && !wraps_) return std::nullopt;
  const auto at = uint16_t(wrap(v, side));
  return a.x ? ExemplarPixel{at, p.y} : ExemplarPixel{p.x, at};
}

ExemplarPixel StreakedSurface::first_of(const Axis& a, ExemplarPixel step) const {
  return a.x ? ExemplarPixel{uint16_t(step.x * a.step), step.y} : ExemplarPixel{step.x, uint16_t(step.y * a.step)};
}

int StreakedSurface::random_streak_end(const Axis& a, int along, int across) const {
  return int(random_bits(options_.seed, uint64_t(along), uint64_t(across)) % uint64_t(a.step));
}

std::optional<ExemplarPixel> StreakedSurface::beside_kept(const Axis& a, int x, int y) const {
  const Size surface = options_.size;
  const int side = a.x ? surface.width : surface.height, across = a.x ? y : x;
  for (int away = 1; away < a.step; away++)
    for (const int by : {away, -away}) {
      int along = (a.x ? x : y) + by;
      if (!a.tiles && (along < 0 || along >= side)) continue;
      along = wrap(along, side);
      const size_t at = size_t(a.x ? y : along) * surface.width + size_t(a.x ? along : x);
      if (options_.kept.keep[at] == Keep::always && away <= random_streak_end(a, along, across))
        return along_streak(a, options_.kept.pixels[at], -by);
    }
  return std::nullopt;
}

std::optional<ExemplarPixel> StreakedSurface::kept_at(const Axis& a, int x, int y, ExemplarPixel step) const {
  if (options_.kept.empty()) return std::nullopt;
  const size_t at = size_t(y) * options_.size.width + x;
  const Keep keep = options_.kept.keep[at];
  const bool unchanged = keep == Keep::at_first && shortened(options_.kept.pixels[at]) == step;
  return keep == Keep::always || unchanged ? options_.kept.pixels[at] : beside_kept(a, x, y);
}

Field StreakedSurface::stretched(Field field, const Rect& region) const {
  if (!streaks_.any()) return field;
  const Axis a = along(region);
  const auto shown = [&](int step, int row) -> std::optional<ExemplarPixel> {
    const std::optional<int> at = a.place(step);
    if (!at) return std::nullopt;
    return first_of(a, a.x ? field.at(*at, row) : field.at(row, *at));
  };
  Field out{{region.width, region.height}, std::vector<ExemplarPixel>(size_t(region.area()))};
  tbb::parallel_for(0, region.height, [&](int j) {
    for (int i = 0; i < region.width; i++) {
      const int x = (region.x + i) % options_.size.width, y = (region.y + j) % options_.size.height;
      const int step = (a.x ? x : y) / a.step, within = (a.x ? x : y) % a.step, row = a.x ? j : i;
      const ExemplarPixel own = *shown(step, row);
      ExemplarPixel& p = out.at(i, j);
      p = *along_streak(a, own, within);
      // Where a streak ends is drawn by lot, so that ends do not line up.
      const bool goes_on = within < random_streak_end(a, step, a.x ? y : x);
      if (const std::optional<ExemplarPixel> before = goes_on ? shown(step - 1, row) : std::nullopt)
        p = along_streak(a, *before, a.step + within).value_or(p);
      p = kept_at(a, x, y, shortened(own)).value_or(p);
    }
  });
  return out;
}

}  // namespace terrazzo
