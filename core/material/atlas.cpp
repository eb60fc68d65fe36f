#include "core/material/atlas.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/tuning.h"
#include "core/image/image_ops.h"
#include "core/material/adapted_map.h"
#include "core/material/map_names.h"

namespace terrazzo {

namespace {

constexpr int64_t longest_side = 65536;

struct AtlasTuning {
  double unlike_sides = 0.05;
};
const Tunable<AtlasTuning> atlas_tuning("atlas",
                                        {
                                            {&AtlasTuning::unlike_sides, "unlike_sides", "factor",
                                             "on the square of what sides differ by, beside the area. Higher: atlases "
                                             "are nearer to squares; lower: they waste less",
                                             "not measured: taken over from the code before constants were listed"},
                                        });

// --- Where exemplars lie

struct Shelf {
  int64_t top = 0, height = 0, right = 0;
  std::vector<size_t> items;
};

/// Places sizes in the order given and starts a new shelf whenever one would become wider than `width`.
std::vector<Shelf> shelves_of(const std::vector<Size>& sizes, const std::vector<size_t>& order, int64_t width,
                              int gap) {
  std::vector<Shelf> shelves;
  for (const size_t i : order) {
    if (shelves.empty() || shelves.back().right + gap + sizes[i].width > width) {
      const int64_t top = shelves.empty() ? 0 : shelves.back().top + shelves.back().height + gap;
      shelves.push_back({top, 0, -gap, {}});
    }
    Shelf& s = shelves.back();
    s.right += gap + sizes[i].width;
    s.height = std::max<int64_t>(s.height, sizes[i].height);
    s.items.push_back(i);
  }
  return shelves;
}

struct Extent {
  int64_t width = 0, height = 0;
  explicit Extent(const std::vector<Shelf>& shelves) {
    for (const Shelf& s : shelves) {
      width = std::max(width, s.right);
      height = s.top + s.height;
    }
  }
  /// The cost of a layout: its area plus a little for its distance from a square.
  double cost() const {
    return double(width) * double(height) +
           atlas_tuning->unlike_sides * double(width - height) * double(width - height);
  }
};

struct Layout {
  Size size;
  std::vector<Rect> places;
  std::vector<Rect> cells;  ///< a partition of the atlas, one for each place and around it
};

/// `multiple`: all sizes are multiples of it, and so are all coordinates of the result.
Layout layout_of(const std::vector<Size>& sizes, int gap, int multiple) {
  gap = (gap + multiple - 1) / multiple * multiple;
  std::vector<size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return sizes[a].height > sizes[b].height; });
  std::vector<Shelf> best;
  int64_t widest = 0, width = -gap;
  for (const Size& s : sizes) widest = std::max<int64_t>(widest, s.width);
  for (const size_t i : order) {
    width += gap + sizes[i].width;
    std::vector<Shelf> shelves = shelves_of(sizes, order, std::max(width, widest), gap);
    if (best.empty() || Extent(shelves).cost() <= Extent(best).cost()) best = std::move(shelves);
  }
  const Extent extent(best);
  if (extent.width > longest_side || extent.height > longest_side)
    throw Error("materials", fmt::format("side by side the exemplars take {}x{} pixels, more than {} a side; use "
                                         "fewer, or put \"resize\" before this",
                                         extent.width, extent.height, longest_side));
  Layout layout{
      {int(extent.width), int(extent.height)}, std::vector<Rect>(sizes.size()), std::vector<Rect>(sizes.size())};
  const int before = gap / 2 / multiple * multiple;  // the part of a gap that belongs to the exemplar after it
  for (size_t s = 0; s < best.size(); s++) {
    const int top = int(best[s].top) - (s > 0 ? before : 0);
    const int bottom = s + 1 < best.size() ? int(best[s + 1].top) - before : layout.size.height;
    int x = 0;
    for (const size_t i : best[s].items) {
      layout.places[i] = {x, int(best[s].top), sizes[i].width, sizes[i].height};
      const int left = x > 0 ? x - before : 0, next = x + sizes[i].width + gap;
      const int right = i == best[s].items.back() ? layout.size.width : next - before;
      layout.cells[i] = {left, top, right - left, bottom - top};
      x = next;
    }
  }
  return layout;
}

// --- Images

/// One exemplar's share of a map of the atlas.
struct Part {
  ImagePtr image;
  Rect place, cell;
};

Rect divided(const Rect& r, int by) {
  return {r.x / by, r.y / by, r.width / by, r.height / by};
}

/// A rectangle of the atlas in the coordinates of a part's image.
Rect shown_of(const Part& part, const Rect& shown) {
  return {shown.x - part.place.x, shown.y - part.place.y, shown.width, shown.height};
}

void read_parts(const std::vector<Part>& parts, std::span<const PixelView> images, int channels, Outside outside,
                const Rect& region, float* out) {
  for (size_t i = 0; i < parts.size(); i++) {
    const Rect shown = intersect(region, parts[i].cell);
    if (shown.empty()) continue;
    const std::vector<float> pixels = read_padded(images[i], shown_of(parts[i], shown), outside);
    const size_t row = size_t(shown.width) * channels;
    for (int y = 0; y < shown.height; y++)
      std::copy_n(&pixels[y * row], row,
                  out + (size_t(shown.y - region.y + y) * region.width + (shown.x - region.x)) * channels);
  }
}

/// The sources and reads of an image made of parts.
Operation operation_on(const std::vector<Part>& parts, Outside outside) {
  Operation operation{.sources = {}, .compute = {}};
  for (const Part& p : parts) operation.sources.push_back(p.image);
  operation.reads = [=](size_t i, const Rect& region) -> std::vector<Rect> {
    const Rect shown = intersect(region, parts[i].cell);
    if (shown.empty()) return {};
    return padded_parts(parts[i].image->size(), shown_of(parts[i], shown), outside);
  };
  return operation;
}

ImagePtr map_of_parts(const ImageInfo& info, const std::vector<Part>& parts, Outside outside) {
  Hasher recipe;
  recipe.add("atlas").add(int(outside)).add(info.size.width).add(info.size.height);
  for (const Part& p : parts) recipe.add(p.image->digest()).add(p.place.x).add(p.place.y).add(p.cell.x).add(p.cell.y);
  Operation operation = operation_on(parts, outside);
  operation.compute = [=, channels = info.channels](std::span<const PixelView> in, const Rect& region, float* out) {
    read_parts(parts, in, channels, outside, region, out);
  };
  return Image::computed(info, recipe.digest(), std::move(operation));
}

/// The largest factor by which a map can be smaller than the material in the atlas.
int common_divisor(const std::vector<Exemplar>& exemplars, const std::string& map) {
  int divisor = 0;
  for (const Exemplar& e : exemplars)
    divisor = std::gcd(divisor, divisor_of(e.material->find(map)->size(), e.material->size()));
  return divisor;
}

ImagePtr atlas_map(const std::vector<Exemplar>& exemplars, const std::string& name, const Layout& layout,
                   Outside outside) {
  const int divisor = common_divisor(exemplars, name);
  ImageInfo info = exemplars.front().material->find(name)->info();
  std::vector<Part> parts;
  for (size_t i = 0; i < exemplars.size(); i++) {
    const Material& material = *exemplars[i].material;
    const ImagePtr map = adapted_map(material, i, name, info);
    info.depth = std::max(info.depth, map->info().depth);
    const Rect place = divided(layout.places[i], divisor);
    parts.push_back({nearest_at_size(map, {place.width, place.height}), place, divided(layout.cells[i], divisor)});
  }
  info.size = {layout.size.width / divisor, layout.size.height / divisor};
  return map_of_parts(info, parts, outside);
}

ImagePtr constant(Size size, float value) {
  const ImageInfo info{.size = size, .channels = 1, .semantic = Semantic::mask};
  const Digest recipe = Hasher().add("constant").add(size.width).add(size.height).add(double(value)).digest();
  return Image::computed(info, recipe,
                         [value](const Rect& region, float* out) { std::fill_n(out, region.area(), value); });
}

ImagePtr atlas_mask(const std::vector<Exemplar>& exemplars, const Layout& layout) {
  const ImageInfo info{.size = layout.size, .channels = 1, .semantic = Semantic::mask, .depth = Depth::u8};
  std::vector<Part> parts;
  for (size_t i = 0; i < exemplars.size(); i++) {
    const Rect& place = layout.places[i];
    const Size size{place.width, place.height};
    parts.push_back({exemplars[i].mask ? nearest_at_size(exemplars[i].mask, size) : constant(size, 1), place, place});
  }
  Hasher recipe;
  recipe.add("atlas mask").add(info.size.width).add(info.size.height);
  for (const Part& p : parts) recipe.add(p.image->digest()).add(p.place.x).add(p.place.y);
  Operation operation = operation_on(parts, Outside::clamp);
  operation.compute = [=](std::span<const PixelView> in, const Rect& region, float* out) {
    std::fill_n(out, region.area(), 0.0f);
    read_parts(parts, in, 1, Outside::clamp, region, out);
    for (int64_t i = 0; i < region.area(); i++) out[i] = out[i] > 0.5f ? 1.0f : 0.0f;
  };
  return Image::computed(info, recipe.digest(), std::move(operation));
}

ImagePtr atlas_labels(const Layout& layout) {
  const ImageInfo info{.size = layout.size, .channels = 1, .semantic = Semantic::guidance, .depth = Depth::u16};
  const size_t count = layout.cells.size();
  std::vector<Part> parts;
  for (size_t i = 0; i < count; i++) {
    const Rect& cell = layout.cells[i];
    const float label = count > 1 ? float(double(i) / double(count - 1)) : 0.0f;
    parts.push_back({constant({cell.width, cell.height}, label), cell, cell});
  }
  return map_of_parts(info, parts, Outside::clamp);
}

}  // namespace

Atlas make_atlas(const std::vector<Exemplar>& exemplars, int gap, Outside outside) {
  std::vector<KnownMaps> maps_of_all;
  for (const Exemplar& e : exemplars)
    maps_of_all.push_back({e.material->name(), names_of(e.material->maps()), std::vector<std::string>{}});
  require_same_maps("materials", maps_of_all);
  std::vector<Size> sizes;
  sizes.reserve(exemplars.size());
  for (const Exemplar& e : exemplars) sizes.push_back(e.material->size());
  int multiple = 1;
  for (const Map& m : exemplars.front().material->maps())
    multiple = std::lcm(multiple, common_divisor(exemplars, m.name));
  const Layout layout = layout_of(sizes, gap, multiple);
  std::vector<Map> maps;
  for (const Map& m : exemplars.front().material->maps())
    maps.push_back({m.name, atlas_map(exemplars, m.name, layout, outside)});
  return {Material::make(exemplars.front().material->name(), std::move(maps)), atlas_mask(exemplars, layout),
          atlas_labels(layout), layout.places};
}

}  // namespace terrazzo
