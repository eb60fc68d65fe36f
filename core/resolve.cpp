#include "core/resolve.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"

namespace terrazzo {

namespace {

class ResolvedPixels : public PixelSource {
 public:
  // A map's pixels are read over and over, in no order: they are held in memory.
  ResolvedPixels(const ImagePtr& exemplar, UvMapPtr uv) : exemplar_(materialized(exemplar)), uv_(std::move(uv)) {}

  void read(const Rect& region, float* out) const override {
    const int channels = exemplar_->channels(), width = exemplar_->width(), height = exemplar_->height();
    const float* pixels = exemplar_->in_memory();
    const Size analysed = uv_->exemplar();
    const bool same = exemplar_->size() == analysed;
    std::vector<ExemplarPixel> uv(size_t(region.width));
    for (int y = region.y; y < region.bottom(); y++) {
      uv_->read({region.x, y, region.width, 1}, uv.data());
      for (const ExemplarPixel p : uv) {
        const int64_t u = same ? p.x : int64_t{p.x} * width / analysed.width;
        const int64_t v = same ? p.y : int64_t{p.y} * height / analysed.height;
        out = std::copy_n(pixels + (v * width + u) * channels, channels, out);
      }
    }
  }

 private:
  ImagePtr exemplar_;
  UvMapPtr uv_;
};

}  // namespace

ImagePtr resolved(const ImagePtr& exemplar, const UvMapPtr& uv) {
  ImageInfo info = exemplar->info();
  info.size = uv->size();
  const Digest recipe = Hasher().add("resolved").add(exemplar->digest()).add(uv->digest()).digest();
  return Image::computed(info, recipe, std::make_shared<ResolvedPixels>(exemplar, uv));
}

MaterialPtr resolved(const Material& exemplar, const UvMapPtr& uv) {
  const Size has = exemplar.size(), wants = uv->exemplar();
  if (has != wants)
    throw Error("material", fmt::format("the uv map was made for an exemplar of {}x{} pixels, this one has {}x{}",
                                        wants.width, wants.height, has.width, has.height));
  std::vector<Map> maps;
  for (const Map& map : exemplar.maps()) maps.push_back({map.name, resolved(map.image, uv)});
  return Material::make(exemplar.name(), std::move(maps));
}

}  // namespace terrazzo
