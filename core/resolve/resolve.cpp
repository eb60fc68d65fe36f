#include "core/resolve/resolve.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "core/base/error.h"
#include "core/image/image_ops.h"
#include "core/image/normal.h"
#include "core/image/pixel_space.h"
#include "core/material/map_names.h"
#include "core/numeric/box_filter.h"
#include "core/resolve/fine_layout.h"
#include "core/resolve/joined_heights.h"
#include "core/resolve/joined_tones.h"

namespace terrazzo {

namespace {

/// The map in the space in which pixels are averaged.
std::vector<float> linear_pixels(const Image& map) {
  const ImageInfo& info = map.info();
  std::vector<float> pixels = map.pixels();
  tbb::parallel_for(0, info.size.height, [&](int y) {
    to_linear(info, &pixels[size_t(y) * info.size.width * info.channels], info.size.width);
  });
  return pixels;
}

/// Holds the map in memory: its pixels are read repeatedly and in no order.
class ResolvedPixels : public PixelSource {
 public:
  ResolvedPixels(const ImagePtr& map, std::shared_ptr<const FineLayout> layout)
      : map_(held(map)),
        layout_(std::move(layout)),
        same_(map->size() == layout_->exemplar()),
        to_the_pixel_(same_ && layout_->reach() == 0 && layout_->exemplar() == layout_->uv().exemplar()) {
    if (layout_->reach() == 0) return;
    const UvMap& uv = layout_->uv();
    detail_radius_ = layout_->radius() * layout_->exemplar().width / uv.exemplar().width;
    const int radius = std::max(1, int(detail_radius_ * map->width() / layout_->exemplar().width + 0.5));
    linear_ = linear_pixels(*map_);
    smooth_ = local_mean(linear_, map_->size(), map_->channels(), radius, uv.wraps().exemplar);
  }

  void read(const Rect& region, float* out) const override {
    if (to_the_pixel_) return read_to_the_pixel(region, out);
    const LayoutWindow window(*layout_, region);
    std::vector<int> owners(size_t(region.width));
    for (int x = 0; x < region.width; x++) owners[x] = layout_->owner_x(region.x + x);
    for (int y = region.y; y < region.bottom(); y++) {
      const int row = layout_->owner_y(y);
      for (int x = 0; x < region.width;) {
        if (!window.calm(owners[x], row)) {
          out = blend(window, region.x + x++, y, out);
          continue;
        }
        const Offset& offset = window.at(owners[x], row);
        int count = 1;
        while (x + count < region.width && window.at(owners[x + count], row) == offset &&
               window.calm(owners[x + count], row))
          count++;
        out = copy(region.x + x, y, count, offset, out);
        x += count;
      }
    }
  }

 private:
  static constexpr int largest_reach = int(largest_blend + 0.5);
  static constexpr int largest_window = (2 * largest_reach + 1) * (2 * largest_reach + 1);

  /// Each pixel of the uv map names one of the map: runs of a row that are a run there are read at once.
  void read_to_the_pixel(const Rect& region, float* out) const {
    const UvMap& uv = layout_->uv();
    for (int y = region.y; y < region.bottom(); y++) {
      const ExemplarPixel* shown = &uv.pixels()[size_t(y) * uv.size().width + region.x];
      for (int x = 0, count = 1; x < region.width; x += count, count = 1) {
        const ExemplarPixel& first = shown[x];
        while (x + count < region.width && shown[x + count].y == first.y && shown[x + count].x == first.x + count)
          count++;
        map_->read({first.x, first.y, count, 1}, out);
        out += size_t(count) * map_->channels();
      }
    }
  }

  /// The map's pixel for a place of the exemplar.
  Offset place(int x, int y) const {
    const Size size = map_->size(), exemplar = layout_->exemplar();
    if (same_) return {x, y};
    return {int(int64_t{x} * size.width / exemplar.width), int(int64_t{y} * size.height / exemplar.height)};
  }

  /// The index of that pixel.
  size_t position(int x, int y) const {
    const Offset at = place(x, y);
    return (size_t(at.y) * map_->width() + size_t(at.x)) * map_->channels();
  }

  float* copy(int x, int y, int count, const Offset& offset, float* out) const {
    const int channels = map_->channels();
    int u = x + offset.x, v = y + offset.y;
    layout_->settle(u, v);
    if (same_ && u == x + offset.x && u + count <= map_->width()) {
      map_->read({u, v, count, 1}, out);
      return out + size_t(count) * channels;
    }
    for (int i = 0; i < count; i++, out += channels) {
      u = x + i + offset.x;
      v = y + offset.y;
      layout_->settle(u, v);
      const Offset at = place(u, v);
      map_->read({at.x, at.y, 1, 1}, out);
    }
    return out;
  }

  struct Proposal {
    size_t position;
    int x, y;  ///< in the exemplar
    double weight;
  };

  float* blend(const LayoutWindow& window, int x, int y, float* out) const {
    std::array<Proposal, largest_window> proposals;
    int count = 0;
    const int reach = layout_->reach(), column = layout_->owner_x(x), row = layout_->owner_y(y);
    const double area = layout_->radius() * layout_->radius();
    for (int j = row - reach; j <= row + reach; j++) {
      const double dy = layout_->distance_y(j, y);
      for (int i = column - reach; i <= column + reach; i++) {
        const double dx = layout_->distance_x(i, x), share = 1 - (dx * dx + dy * dy) / area;
        const Offset& offset = window.at(i, j);
        int u = x + offset.x, v = y + offset.y;
        if (share <= 0 || !layout_->inside(u, v)) continue;
        const size_t at = position(u, v);
        const auto end = proposals.begin() + count;
        const auto known = std::find_if(proposals.begin(), end, [at](const Proposal& p) { return p.position == at; });
        if (known == end)
          proposals[size_t(count++)] = {at, u, v, share * share};
        else
          known->weight += share * share;
      }
    }
    if (count < 2) return copy(x, y, 1, window.at(column, row), out);
    return mean(proposals.data(), count, out);
  }

  /// The factor that gives the mean of several details the variance of one. Details from nearly the same place
  /// correlate.
  double contrast(const Proposal* proposals, int count) const {
    double variance = 0;
    for (int i = 0; i < count; i++)
      for (int j = 0; j < count; j++) {
        const int apart =
            std::max(std::abs(proposals[i].x - proposals[j].x), std::abs(proposals[i].y - proposals[j].y));
        variance += proposals[i].weight * proposals[j].weight * std::max(0.0, 1 - apart / detail_radius_);
      }
    return 1 / std::sqrt(variance);
  }

  float* mean(Proposal* proposals, int count, float* out) const {
    const ImageInfo& info = map_->info();
    double weights = 0;
    for (int i = 0; i < count; i++) weights += proposals[i].weight;
    for (int i = 0; i < count; i++) proposals[i].weight /= weights;
    const double factor = contrast(proposals, count);
    for (size_t c = 0; c < size_t(info.channels); c++) {
      double smooth = 0, detail = 0;
      float least = linear_[proposals->position + c], most = least;
      for (int i = 0; i < count; i++) {
        const size_t at = proposals[i].position + c;
        smooth += proposals[i].weight * double(smooth_[at]);
        detail += proposals[i].weight * (double(linear_[at]) - double(smooth_[at]));
        least = std::min(least, linear_[at]);
        most = std::max(most, linear_[at]);
      }
      // Where the pieces agree, their details need no more contrast.
      out[c] = std::clamp(float(smooth + factor * detail), least, most);
    }
    to_stored(info, out, 1);
    if (info.semantic == Semantic::normal && info.channels >= 3) set_length(proposals, count, out);
    return out + info.channels;
  }

  /// Gives a unit normal the length of the proposals: 1, unless the map was filtered without normalizing; there a
  /// normal longer than its neighbours would show.
  void set_length(const Proposal* proposals, int count, float* out) const {
    double sum = 0;
    for (int i = 0; i < count; i++)
      sum += proposals[i].weight * double(length(decode_normal(&linear_[proposals[i].position], NormalY::up)));
    encode_normal(decode_normal(out, NormalY::up) * float(sum), NormalY::up, out);
    keep_in_range(map_->info(), out, 1);
  }

  ImagePtr map_;
  std::shared_ptr<const FineLayout> layout_;
  bool same_;                  ///< the map has the exemplar's size
  bool to_the_pixel_;          ///< and so has the analysed exemplar, and nothing is blended
  double detail_radius_ = 0;   ///< in pixels of the exemplar
  std::vector<float> linear_;  ///< the map in the space of linear_pixels
  std::vector<float> smooth_;  ///< its local mean
};

ImagePtr resolved_map(const ImagePtr& map, const std::shared_ptr<const FineLayout>& layout) {
  ImageInfo info = map->info();
  info.size = layout->size();
  Hasher recipe;
  recipe.add("resolved").add(map->digest()).add(layout->uv().digest());
  recipe.add(layout->exemplar().width).add(layout->exemplar().height).add(layout->radius());
  return Image::computed(info, recipe.digest(), std::make_shared<ResolvedPixels>(map, layout));
}

/// Whether the exemplar is the analysed one enlarged by `scale`, up to rounding to whole pixels.
bool fits(Size exemplar, Size analysed, double scale) {
  const double off = scale == 1 ? 0 : scale;
  return std::abs(analysed.width * scale - exemplar.width) <= off &&
         std::abs(analysed.height * scale - exemplar.height) <= off;
}

/// The kept pixels of a map.
KeptPixels kept_pixels(const ResolveOptions& options, const Map& map, const FineLayout& layout) {
  if (!options.kept) return {};
  const ImagePtr kept = options.kept->find(map.name);
  if (!kept || kept->info().semantic != map.image->info().semantic || kept->channels() != map.image->channels())
    throw Error("kept",
                fmt::format("expected the map \"{}\" of the material, {} in {} channels; found {}", map.name,
                            name_of(map.image->info().semantic), map.image->channels(), options.kept->map_names()));
  const double scale_x = double(layout.size().width) / layout.uv().size().width;
  const double scale_y = double(layout.size().height) / layout.uv().size().height;
  return {.map = nearest_at_size(kept, options.kept->size()),
          .x = int(std::floor(options.kept_at[0] * scale_x + 0.5)),
          .y = int(std::floor(options.kept_at[1] * scale_y + 0.5)),
          .holes = options.holes};
}

}  // namespace

bool can_blend(Semantic semantic) {
  return semantic != Semantic::mask && semantic != Semantic::data;
}

void require_scale(Size exemplar, Size analysed, double scale) {
  const double found = double(exemplar.width) / analysed.width;
  const bool enlarged = found >= 1 && found <= largest_scale && fits(exemplar, analysed, found);
  if (scale == 0 ? enlarged : fits(exemplar, analysed, scale)) return;
  const std::string hint = enlarged && found > 1 && scale != 0
                               ? fmt::format("; set \"scale\" to {:.6g} to enlarge the result accordingly", found)
                               : "";
  if (scale == 0 || scale == 1)
    throw Error("material", fmt::format("the uv map was made for an exemplar of {}x{} pixels, this one has {}x{}{}",
                                        analysed.width, analysed.height, exemplar.width, exemplar.height, hint));
  throw Error("material", fmt::format("the uv map was made for an exemplar of {}x{} pixels; a scale of {} needs one of "
                                      "{:.0f}x{:.0f}, this one has {}x{}{}",
                                      analysed.width, analysed.height, scale, analysed.width * scale,
                                      analysed.height * scale, exemplar.width, exemplar.height, hint));
}

Size resolved_size(Size uv, Size analysed, Size exemplar) {
  return FineLayout::size_of(uv, analysed, exemplar);
}

std::map<std::string, SlowTonesPtr> slow_tones(const Material& exemplar, const UvMap& uv, double reach,
                                               const Task& task) {
  std::map<std::string, SlowTonesPtr> out;
  if (reach == 0) return out;
  const Size size = exemplar.size();
  const double pixels =
      reach < 1 ? reach * std::min(size.width, size.height) : reach * size.width / uv.exemplar().width;
  for (const Map& map : exemplar.maps()) {
    if (!SlowTones::exist_in(map.image->info())) continue;
    const auto tones =
        std::make_shared<const SlowTones>(map.image, size, std::max(1.0, pixels), uv.wraps().exemplar, task);
    if (tones->are_slow()) out[map.name] = tones;
  }
  return out;
}

MaterialPtr resolved(const Material& exemplar, const UvMapPtr& uv, const ResolveOptions& options, const Task& task) {
  const Size size = exemplar.size();
  require_one_shape("material", exemplar);
  require_scale(size, uv->exemplar(), options.scale);
  const auto exact = std::make_shared<FineLayout>(uv, size, 0);
  const auto blended = options.blend > 0 ? std::make_shared<FineLayout>(uv, size, options.blend) : exact;
  const Size analysed = uv->exemplar();
  const double reach = options.join * (options.join < 1 ? std::min(analysed.width, analysed.height) : 1);
  std::vector<Map> maps;
  for (const Map& map : exemplar.maps()) {
    const ImageInfo& info = map.image->info();
    if (reach > 0 && can_join(info)) {
      maps.push_back({map.name, joined_heights(map.image, exact, reach, kept_pixels(options, map, *exact), task)});
      continue;
    }
    ImagePtr image = resolved_map(map.image, can_blend(info.semantic) ? blended : exact);
    if (const auto tones = options.tones.find(map.name); tones != options.tones.end())
      image = joined_tones(image, map.image, exact, tones->second, kept_pixels(options, map, *exact), task);
    maps.push_back({map.name, std::move(image)});
  }
  return Material::make(exemplar.name(), std::move(maps),
                        exemplar.metres() * std::array{double(uv->size().width) / analysed.width,
                                                       double(uv->size().height) / analysed.height});
}

}  // namespace terrazzo
