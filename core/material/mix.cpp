#include "core/material/mix.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/tuning.h"
#include "core/filter/resample.h"
#include "core/image/image_facts.h"
#include "core/image/image_ops.h"
#include "core/image/normal.h"
#include "core/image/pixel_space.h"
#include "core/material/adapted_map.h"
#include "core/material/map_names.h"
#include "core/numeric/distance_transform.h"

namespace terrazzo {

namespace {

struct MixTuning {
  int rows = 64;
};
const Tunable<MixTuning> mix_tuning("mix",
                                    {{&MixTuning::rows, "rows", "rows",
                                      "of each height map that are read for the range of heights. Higher: the range is "
                                      "nearer to the true one; costs time",
                                      "not measured: a row in 16 of 1024, and stones are higher than a few rows", 1}});

// --- Areas of the materials

/// The map in the materials' size. With more than two labels nothing is interpolated: a value between two labels would
/// stand for a third.
ImagePtr map_at_size(const ImagePtr& map, Size size, size_t materials, const MixOptions& options) {
  if (materials > 2) return nearest_at_size(map, size);
  const Outside outside = options.wraps_x && options.wraps_y ? Outside::wrap : Outside::clamp;
  Hasher recipe;
  recipe.add("mix map").add(map->digest()).add(int(outside)).add(size.width).add(size.height);
  return resampled(map, size, "triangle", outside, recipe.digest());
}

/// The region grown by `by`, clipped to the image.
Rect surroundings(const Rect& region, int by, Size size, const MixOptions& options) {
  Rect out = grown(region, by);
  if (!options.wraps_x) out = intersect(out, {0, out.y, size.width, out.height});
  if (!options.wraps_y) out = intersect(out, {out.x, 0, out.width, size.height});
  return out;
}

/// How far each pixel lies inside a material's area, negative outside; exact up to half a border.
ImagePtr distances_inside(const ImagePtr& map, size_t material, size_t materials, const MixOptions& options,
                          double half) {
  const Size size = map->size();
  const int around = half > 0 ? int(std::ceil(half)) + 1 : 0;
  const auto window = [=](const Rect& region) { return surroundings(region, around, size, options); };
  Operation operation{.sources = {map}, .compute = {}};
  operation.work = 20;
  operation.keeps = around > 0;
  operation.reads = [=](size_t, const Rect& region) { return padded_parts(size, window(region), Outside::wrap); };
  operation.compute = [=](std::span<const PixelView> in, const Rect& region, float* out) {
    const Rect all = window(region);
    const std::vector<float> values = read_padded(in[0], all, Outside::wrap);
    std::vector<uint8_t> others(values.size());
    for (size_t i = 0; i < values.size(); i++) others[i] = material_at(values[i], materials) != material;
    const std::vector<float> found = signed_distances_here(others, {all.width, all.height}, float(around + 1));
    for (int y = 0; y < region.height; y++)
      std::copy_n(&found[size_t(region.y - all.y + y) * all.width + (region.x - all.x)], region.width,
                  out + size_t(y) * region.width);
  };
  Hasher recipe;
  recipe.add("distances inside").add(map->digest()).add(int64_t(material)).add(int64_t(materials)).add(around);
  recipe.add(options.wraps_x).add(options.wraps_y);
  return Image::computed({.size = size, .channels = 1}, recipe.digest(), std::move(operation));
}

/// One image for each material; only the second's for two materials.
std::vector<ImagePtr> all_distances(const ImagePtr& map, size_t materials, const MixOptions& options, double half) {
  std::vector<ImagePtr> out;
  for (size_t i = materials == 2 ? 1 : 0; i < materials; i++)
    out.push_back(distances_inside(map, i, materials, options, half));
  return out;
}

std::vector<double> parts_of(const Image& map, size_t materials) {
  std::vector<double> parts(materials);
  for_each_strip(map, [&](const Rect& strip, const float* values) {
    for (int64_t i = 0; i < strip.area(); i++) parts[material_at(values[i], materials)]++;
  });
  for (double& part : parts) part /= double(map.size().area());
  return parts;
}

// --- Mixed pixels

/// The inputs that all maps of a mix share.
struct MixLayers {
  BorderShape shape;
  std::vector<ImagePtr> distances{};
  std::vector<ImagePtr> heights{};  ///< of each material, for borders by height
  size_t count = 0;
};

void set_range(BorderShape& shape, const std::vector<ImagePtr>& heights) {
  float lowest = std::numeric_limits<float>::max(), highest = std::numeric_limits<float>::lowest();
  for (const ImagePtr& map : heights) {
    const int rows = std::min(map->height(), mix_tuning->rows);
    for (int k = 0; k < rows; k++)
      for (const float v : map->read({0, int((2 * int64_t{k} + 1) * map->height() / (2 * rows)), map->width(), 1})) {
        if (!std::isfinite(v)) continue;
        lowest = std::min(lowest, v);
        highest = std::max(highest, v);
      }
  }
  shape.lowest = double(lowest);
  shape.range = std::max(0.0, double(highest) - double(lowest));
}

std::vector<ImagePtr> compared_heights(const std::vector<MaterialPtr>& materials) {
  std::vector<ImagePtr> heights;
  for (const MaterialPtr& m : materials) {
    require_height_to_compare(names_of(m->maps()), "a material");
    const ImagePtr height = m->find(Semantic::height);
    if (!height || height->channels() != 1)
      throw Error("border", "height compares height maps of 1 channel" +
                                (height ? ", found " + describe(*height) : std::string(", found none")));
    heights.push_back(height);
  }
  return heights;
}

/// The pixels of one map, mixed by the shares.
class MixedPixels {
 public:
  MixedPixels(const MixLayers& layers, const ImageInfo& info, bool sinks)
      : shape_(layers.shape),
        count_(layers.count),
        distances_(layers.distances.size()),
        heights_(layers.heights.size()),
        info_(info),
        sinks_(sinks) {}

  void operator()(std::span<const float* const> in, float* out, int64_t pixels) const {
    MixShares shares(count_, shape_);
    std::vector<float> distance(count_), height(heights_), pixel(size_t(info_.channels));
    const std::span<const float* const> maps = in.subspan(distances_ + heights_);
    for (int64_t p = 0; p < pixels; p++, out += info_.channels) {
      for (size_t i = 0; i < count_; i++) distance[i] = distances_ == count_ ? in[i][p] : i == 0 ? -in[0][p] : in[0][p];
      for (size_t i = 0; i < heights_; i++) height[i] = in[distances_ + i][p];
      shares.set(distance.data(), height.data());
      const size_t most = greatest(shares);
      const float* shown = maps[most] + p * info_.channels;
      if (!averages() || shares.share(most) >= 1)
        show(shown, sinks_ ? shares.sunk(most) : 0, out);
      else
        mix(shares, maps, p, pixel, out);
    }
  }

 private:
  bool averages() const { return can_be_averaged(info_) && info_.semantic != Semantic::data; }

  size_t greatest(const MixShares& shares) const {
    size_t most = 0;
    for (size_t i = 1; i < count_; i++)
      if (shares.share(i) > shares.share(most)) most = i;
    return most;
  }

  void show(const float* pixel, float sunk, float* out) const {
    std::copy_n(pixel, info_.channels, out);
    if (sunk == 0) return;
    out[0] -= sunk;
    keep_in_range(info_, out, 1);
  }

  void mix(const MixShares& shares, std::span<const float* const> maps, int64_t p, std::vector<float>& pixel,
           float* out) const {
    std::fill_n(out, info_.channels, 0.0f);
    for (size_t i = 0; i < count_; i++) {
      if (shares.share(i) == 0) continue;
      std::copy_n(maps[i] + p * info_.channels, info_.channels, pixel.data());
      to_linear(info_, pixel.data(), 1);
      if (info_.semantic == Semantic::normal && info_.channels >= 3) renormalize(pixel.data(), info_.channels, 1);
      if (sinks_) pixel[0] -= shares.sunk(i);
      for (int c = 0; c < info_.channels; c++) out[c] += shares.share(i) * pixel[size_t(c)];
    }
    to_stored(info_, out, 1);
  }

  BorderShape shape_;
  size_t count_, distances_, heights_;
  ImageInfo info_;
  bool sinks_;  ///< the map is a height map, whose intruders are lowered
};

ImagePtr mixed_image(const MixLayers& layers, const ImageInfo& info, const std::vector<ImagePtr>& maps, bool sinks) {
  std::vector<ImagePtr> inputs;
  for (const std::vector<ImagePtr>& images : {layers.distances, layers.heights, maps})
    for (const ImagePtr& image : images) inputs.push_back(nearest_at_size(image, info.size));
  const BorderShape& shape = layers.shape;
  Hasher recipe;
  recipe.add("mixed").add(int(shape.border)).add(shape.half()).add(shape.softness).add(shape.offset);
  recipe.add(shape.lowest).add(shape.range).add(sinks).add(int64_t(layers.count)).add(int64_t(layers.heights.size()));
  info.add_to(recipe);
  for (const ImagePtr& image : inputs) recipe.add(image->digest());
  return pixel_by_pixel(info, recipe.digest(), inputs, MixedPixels(layers, info, sinks));
}

ImagePtr mixed_map(const MixLayers& layers, const std::vector<MaterialPtr>& materials, const std::string& name) {
  ImageInfo info = materials.front()->find(name)->info();
  std::vector<ImagePtr> maps;
  for (size_t i = 0; i < materials.size(); i++) {
    maps.push_back(adapted_map(*materials[i], i, name, info));
    const ImageInfo& own = maps.back()->info();
    info.depth = std::max(info.depth, own.depth);
    if (own.size.area() > info.size.area()) info.size = own.size;
  }
  const bool compared = !layers.heights.empty() && materials.front()->find(name) == layers.heights.front();
  return mixed_image(layers, info, maps, compared);
}

ImagePtr labels_of(const MixLayers& layers, Size size) {
  const ImageInfo info{.size = size, .channels = 1, .semantic = Semantic::guidance, .depth = Depth::u16};
  std::vector<ImagePtr> labels;
  for (size_t i = 0; i < layers.count; i++) {
    const float label = layers.count > 1 ? float(double(i) / double(layers.count - 1)) : 0.0f;
    const Digest recipe = Hasher().add("label").add(double(label)).add(size.width).add(size.height).digest();
    labels.push_back(Image::computed(
        info, recipe, [label](const Rect& region, float* out) { std::fill_n(out, region.area(), label); }));
  }
  return mixed_image(layers, info, labels, false);
}

}  // namespace

size_t material_at(float value, size_t materials) {
  const double last = double(materials - 1), at = std::ceil(double(value) * last - 0.5);
  return at > 0 ? size_t(std::min(at, last)) : 0;  // not a number: the first
}

void require_height_to_compare(const std::vector<std::string>& maps, const std::string& whose) {
  if (std::ranges::any_of(maps, [](const std::string& map) { return semantic_of_map(map) == Semantic::height; }))
    return;
  throw Error("border", fmt::format("height compares height maps, and {} has only {}; add one, such as \"make_height\" "
                                    "makes of normals, or set \"border\" to soft",
                                    whose, fmt::join(maps, ", ")));
}

void require_one_size(Size first, Size size) {
  if (size == first) return;
  throw Error(
      "materials",
      fmt::format("materials that are laid over each other must have one size; the first has {} pixels, another "
                  "{}; make both in one size, or put \"resize\" before this",
                  describe(first), describe(size)));
}

Mix mixed(const std::vector<MaterialPtr>& materials, const ImagePtr& map, const MixOptions& options) {
  std::vector<KnownMaps> known;
  for (const MaterialPtr& m : materials) known.push_back({m->name(), names_of(m->maps()), std::vector<std::string>{}});
  require_same_maps("materials", known);
  for (const MaterialPtr& m : materials) require_one_size(materials.front()->size(), m->size());
  require_one_channel("mix", *map);
  MixLayers layers{.shape = {.border = options.border,
                             .width = options.width,
                             .softness = options.softness,
                             .offset = options.offset},
                   .count = materials.size()};
  const Size size = materials.front()->size();
  if (options.border == Border::height) layers.heights = compared_heights(materials);
  if (layers.shape.half() == 0) layers.heights.clear();
  if (!layers.heights.empty()) set_range(layers.shape, layers.heights);
  const ImagePtr full = map_at_size(map, size, materials.size(), options);
  layers.distances = all_distances(full, materials.size(), options, layers.shape.half());
  std::vector<Map> maps;
  for (const Map& m : materials.front()->maps()) maps.push_back({m.name, mixed_map(layers, materials, m.name)});
  return {Material::make(materials.front()->name(), std::move(maps), materials.front()->metres()),
          labels_of(layers, size), parts_of(*map, materials.size())};
}

}  // namespace terrazzo
