#include "core/synthesis/synthesize.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/image/image_facts.h"
#include "core/synthesis/level_work.h"
#include "core/synthesis/streaked_surface.h"

namespace terrazzo {

namespace {

/// The finest level that is worked out for the plane as a whole.
int coarse_level(const SharedWork& s) {
  return std::min(s.levels - 1, finest_whole_level);
}

/// Lets people see a level. Its pixels are those of the same level of the exemplar: each stands for the middle of a
/// block. Streaks are drawn out as they lie; where they end is only decided at the finest level.
void show_level(const SharedWork& s, int level, const Field& field) {
  if (!s.task.is_previewed()) return;
  const Appearance& appearance = *s.index.appearance();
  const Size size = appearance.size();
  const int x_step = appearance.repeats().streaks.x, y_step = appearance.repeats().streaks.y;
  const auto middle = [&](int at, int step, int within, int side) {
    return uint16_t(std::min(side - 1, (((at * step + within) * 2 + 1) << level) / 2));
  };
  Field shown{{field.size.width * x_step, field.size.height * y_step}, {}};
  shown.pixels.reserve(size_t(shown.size.area()));
  for (int y = 0; y < shown.size.height; y++)
    for (int x = 0; x < shown.size.width; x++) {
      const ExemplarPixel p = field.at(x / x_step, y / y_step);
      shown.pixels.push_back(
          {middle(p.x, x_step, x % x_step, size.width), middle(p.y, y_step, y % y_step, size.height)});
    }
  s.task.preview(UvMap::make(shown.size, size, std::move(shown.pixels),
                             {s.options.tile_x, s.options.tile_y, appearance.wraps()}, appearance.fingerprint()));
}

/// What coarse_uv() gives.
Field coarse_field(const SharedWork& s) {
  const int coarsest = s.levels - 1, last = coarse_level(s);
  auto work = std::make_unique<LevelWork>(s, coarsest);
  Field field = work->coarsest_field();
  for (int l = coarsest;; l--) {
    const PlaneWindow all = PlaneWindow::all_of(s.plane(l));
    work->correct(field, all, all.part);
    show_level(s, l, field);
    if (l == 0) return field;
    work = std::make_unique<LevelWork>(s, l - 1);
    field = work->upsampled_blocks(field, all);
    if (l == last) return field;
    work->count_use(field.pixels);
    field = work->initial_field(field.pixels, all, PlaneWindow::all_of(s.plane(l - 1)));
  }
}

Field cropped(Field field, const PlaneWindow& window, const Rect& region) {
  if (window.part == region) return field;
  Field out{{region.width, region.height}, std::vector<ExemplarPixel>(size_t(region.area()))};
  for (int y = 0; y < region.height; y++)
    for (int x = 0; x < region.width; x++)
      out.at(x, y) = field.at(window.column(region.x + x), window.row(region.y + y));
  return out;
}

/// Part of the finest level. `coarse`: the pixels of coarse_field().
Field refined_field(const SharedWork& s, std::span<const ExemplarPixel> coarse, const Rect& region) {
  const PlaneWindow blocks = PlaneWindow::all_of(s.plane(coarse_level(s)));
  if (coarse_level(s) == 0) return cropped({blocks.size(), {coarse.begin(), coarse.end()}}, blocks, region);
  LevelWork work(s, 0);
  const PlaneWindow window = PlaneWindow::around(region, work.reach(), s.plane(0));
  work.count_use(coarse);
  Field field = work.initial_field(coarse, blocks, window);
  work.correct(field, window, window.held(region));
  return cropped(std::move(field), window, region);
}

/// Of the surface, of which `s` synthesizes what is shortened.
UvMapPtr finest_uv(const SharedWork& s, const StreakedSurface& surface, const SynthesisOptions& options,
                   std::span<const ExemplarPixel> coarse, const Rect& region) {
  const Appearance& appearance = *s.index.appearance();
  Field field = surface.stretched(refined_field(s, coarse, surface.shortened(region)), region);
  return UvMap::make(field.size, appearance.size(), std::move(field.pixels),
                     {options.tile_x && region.width == options.size.width,
                      options.tile_y && region.height == options.size.height, appearance.wraps()},
                     appearance.fingerprint());
}

/// The upper left part of a field of that size or larger, or the field with arbitrary pixels added.
Field of_size(Size size, Size from, std::span<const ExemplarPixel> pixels) {
  Field out{size, std::vector<ExemplarPixel>(size_t(size.area()))};
  for (int y = 0; y < std::min(size.height, from.height); y++)
    std::copy_n(pixels.data() + size_t(y) * from.width, std::min(size.width, from.width), &out.at(0, y));
  return out;
}

void require_coarse(const Appearance& appearance, const SynthesisOptions& options, const UvMap& coarse) {
  const Size size = coarse_size(options.size, int(appearance.levels().size()));
  const Size exemplar = appearance.size();
  const UvWraps wraps{options.tile_x, options.tile_y, appearance.wraps()};
  const auto directions = [](const UvWraps& w) { return w.x ? w.y ? "x and y" : "x" : w.y ? "y" : "no direction"; };
  if (coarse.exemplar() != exemplar)
    throw Error("coarse", fmt::format("expected the coarse levels made from the same index (for an exemplar of {}), "
                                      "found a uv map of an exemplar of {}",
                                      describe(exemplar), describe(coarse.exemplar())));
  require_coarse_size(options.size, size, coarse.size());
  if (coarse.wraps() != wraps)
    throw Error("coarse", fmt::format("these coarse levels wrap around in {}, the result in {}; give both nodes the "
                                      "same \"tileable\"",
                                      directions(coarse.wraps()), directions(wraps)));
}

void require_inside(const SynthesisOptions& options, const Rect& region) {
  const auto fits = [](int first, int length, int all, bool tiles) {
    return first >= 0 && length <= all && (tiles ? first < all : first <= all - length);
  };
  if (!fits(region.x, region.width, options.size.width, options.tile_x) ||
      !fits(region.y, region.height, options.size.height, options.tile_y))
    throw Error("origin",
                fmt::format("expected a rectangle inside the surface of {}, found {} at ({}, {})",
                            describe(options.size), describe(Size{region.width, region.height}), region.x, region.y));
}

}  // namespace

UvMapPtr synthesize(const Index& index, const SynthesisOptions& options, const Task& task) {
  const StreakedSurface surface(*index.appearance(), options);
  const SharedWork shared(index, surface.shortened(), task);
  return finest_uv(shared, surface, options, coarse_field(shared).pixels, whole(options.size));
}

UvMapPtr coarse_uv(const Index& index, const SynthesisOptions& options, const Task& task) {
  const Appearance& appearance = *index.appearance();
  const StreakedSurface surface(appearance, options);
  SharedWork shared(index, surface.shortened(), task);
  shared.finest = coarse_level(shared);
  Field field = coarse_field(shared);
  // Whether a surface has streaks is not known before its exemplar is analysed: coarse levels have one size.
  const Size size = coarse_size(options.size, shared.levels);
  if (field.size != size) field = of_size(size, field.size, field.pixels);
  return UvMap::make(size, appearance.size(), std::move(field.pixels),
                     {options.tile_x, options.tile_y, appearance.wraps()}, appearance.fingerprint());
}

Size coarse_size(Size surface, int levels) {
  return level_size(surface, std::min(levels - 1, finest_whole_level));
}

void require_coarse_size(Size surface, Size expected, Size found) {
  if (found != expected)
    throw Error("coarse", fmt::format("a surface of {} has coarse levels of {}, these have {}; give both nodes the "
                                      "same surface",
                                      describe(surface), describe(expected), describe(found)));
}

UvMapPtr refine(const Index& index, const UvMap& coarse, const SynthesisOptions& options, const Rect& region,
                const Task& task) {
  require_coarse(*index.appearance(), options, coarse);
  require_inside(options, region);
  const StreakedSurface surface(*index.appearance(), options);
  const SharedWork shared(index, surface.shortened(), task);
  const Size needed = shared.plane(coarse_level(shared)).size;
  if (needed == coarse.size()) return finest_uv(shared, surface, options, coarse.pixels(), region);
  const Field held = of_size(needed, coarse.size(), coarse.pixels());
  return finest_uv(shared, surface, options, held.pixels, region);
}

}  // namespace terrazzo
