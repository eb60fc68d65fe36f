#include "core/resolve.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "core/error.h"
#include "core/fine_layout.h"
#include "core/pixel_space.h"

namespace terrazzo {

namespace {

/// The map in the space in which pixels are averaged; empty if that is how they are stored.
std::vector<float> linear_pixels(const Image& map) {
  const ImageInfo& info = map.info();
  if (info.color_space != "srgb_texture") return {};
  std::vector<float> pixels(map.in_memory(), map.in_memory() + info.size.area() * info.channels);
  tbb::parallel_for(0, info.size.height, [&](int y) {
    to_linear(info, &pixels[size_t(y) * info.size.width * info.channels], info.size.width);
  });
  return pixels;
}

/// A map's pixels are read over and over, in no order: they are held in memory.
class ResolvedPixels : public PixelSource {
 public:
  ResolvedPixels(const ImagePtr& map, std::shared_ptr<const FineLayout> layout)
      : map_(materialized(map)), layout_(std::move(layout)), same_(map->size() == layout_->exemplar()) {
    if (layout_->reach() > 0) linear_ = linear_pixels(*map_);
  }

  void read(const Rect& region, float* out) const override {
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

  /// Where the map holds what lies at a place of the exemplar.
  size_t position(int x, int y) const {
    const Size size = map_->size(), exemplar = layout_->exemplar();
    if (!same_) {
      x = int(int64_t{x} * size.width / exemplar.width);
      y = int(int64_t{y} * size.height / exemplar.height);
    }
    return (size_t(y) * size.width + size_t(x)) * map_->channels();
  }

  float* copy(int x, int y, int count, const Offset& offset, float* out) const {
    const float* pixels = map_->in_memory();
    const int channels = map_->channels();
    int u = x + offset.x, v = y + offset.y;
    layout_->settle(u, v);
    if (same_ && u == x + offset.x && u + count <= map_->width())
      return std::copy_n(pixels + position(u, v), size_t(count) * channels, out);
    for (int i = 0; i < count; i++) {
      u = x + i + offset.x;
      v = y + offset.y;
      layout_->settle(u, v);
      out = std::copy_n(pixels + position(u, v), channels, out);
    }
    return out;
  }

  struct Proposal {
    size_t position;
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
          proposals[size_t(count++)] = {at, share * share};
        else
          known->weight += share * share;
      }
    }
    if (count < 2) return copy(x, y, 1, window.at(column, row), out);
    return mean(proposals.data(), count, out);
  }

  float* mean(const Proposal* proposals, int count, float* out) const {
    const ImageInfo& info = map_->info();
    const float* pixels = linear_.empty() ? map_->in_memory() : linear_.data();
    std::array<double, 4> sums{};
    double weights = 0;
    for (int i = 0; i < count; i++) {
      weights += proposals[i].weight;
      for (int c = 0; c < info.channels; c++)
        sums[c] += proposals[i].weight * double(pixels[proposals[i].position + c]);
    }
    for (int c = 0; c < info.channels; c++) out[c] = float(sums[c] / weights);
    to_stored(info, out, 1);
    return out + info.channels;
  }

  ImagePtr map_;
  std::shared_ptr<const FineLayout> layout_;
  bool same_;  ///< the map has the exemplar's size
  std::vector<float> linear_;
};

ImagePtr resolved_map(const ImagePtr& map, const std::shared_ptr<const FineLayout>& layout) {
  ImageInfo info = map->info();
  info.size = layout->size();
  Hasher recipe;
  recipe.add("resolved").add(map->digest()).add(layout->uv().digest());
  recipe.add(layout->exemplar().width).add(layout->exemplar().height).add(layout->radius());
  return Image::computed(info, recipe.digest(), std::make_shared<ResolvedPixels>(map, layout));
}

/// Whether the exemplar is the analysed one enlarged by `scale`, but for what rounding to whole pixels may do.
bool fits(Size exemplar, Size analysed, double scale) {
  const double off = scale == 1 ? 0 : scale;
  return std::abs(analysed.width * scale - exemplar.width) <= off &&
         std::abs(analysed.height * scale - exemplar.height) <= off;
}

void check_scale(Size exemplar, Size analysed, double scale) {
  const double found = double(exemplar.width) / analysed.width;
  const bool enlarged = found >= 1 && found <= largest_scale && fits(exemplar, analysed, found);
  if (scale == 0 ? enlarged : fits(exemplar, analysed, scale)) return;
  const std::string hint = enlarged && found > 1 && scale != 0
                               ? fmt::format("; set \"scale\" to {:.6g} for a result as much larger", found)
                               : "";
  if (scale == 0 || scale == 1)
    throw Error("material", fmt::format("the uv map was made for an exemplar of {}x{} pixels, this one has {}x{}{}",
                                        analysed.width, analysed.height, exemplar.width, exemplar.height, hint));
  throw Error("material", fmt::format("the uv map was made for an exemplar of {}x{} pixels; a scale of {} needs one of "
                                      "{:.0f}x{:.0f}, this one has {}x{}{}",
                                      analysed.width, analysed.height, scale, analysed.width * scale,
                                      analysed.height * scale, exemplar.width, exemplar.height, hint));
}

}  // namespace

bool can_blend(Semantic semantic) {
  return semantic != Semantic::mask && semantic != Semantic::data;
}

MaterialPtr resolved(const Material& exemplar, const UvMapPtr& uv, const ResolveOptions& options) {
  const Size size = exemplar.size();
  check_scale(size, uv->exemplar(), options.scale);
  const auto exact = std::make_shared<FineLayout>(uv, size, 0);
  const auto blended = options.blend > 0 ? std::make_shared<FineLayout>(uv, size, options.blend) : exact;
  std::vector<Map> maps;
  for (const Map& map : exemplar.maps())
    maps.push_back({map.name, resolved_map(map.image, can_blend(map.image->info().semantic) ? blended : exact)});
  return Material::make(exemplar.name(), std::move(maps));
}

}  // namespace terrazzo
