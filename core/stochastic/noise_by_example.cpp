#include "core/stochastic/noise_by_example.h"

#include <algorithm>

#include "core/image/image_ops.h"
#include "core/material/map_names.h"
#include "core/stochastic/blending_space.h"
#include "core/stochastic/stochastic_exemplar.h"

namespace terrazzo {

namespace {

/// What all maps share.
struct NoiseSurface {
  StochasticExemplar exemplar;
  TriangleGrid grid;
  std::array<int64_t, 2> origin;

  std::array<GridVertex, 3> around(int x, int y) const { return grid.around(origin[0] + x, origin[1] + y); }
};
using SurfacePtr = std::shared_ptr<const NoiseSurface>;

class BlendedPixels : public PixelSource {
 public:
  BlendedPixels(SurfacePtr surface, const ImageInfo& info, size_t map)
      : surface_(std::move(surface)), info_(info), first_(surface_->exemplar.first_channel(map)) {}

  void read(const Rect& region, float* out) const override {
    for (int y = region.y; y < region.bottom(); y++)
      for (int x = region.x; x < region.right(); x++, out += info_.channels) {
        surface_->exemplar.blend(surface_->around(x, y), first_, info_.channels, out);
        from_blending_space(info_, out, 1);
      }
  }

 private:
  SurfacePtr surface_;
  ImageInfo info_;
  int first_;
};

/// Of a map that may hold labels.
class StrongestPixels : public PixelSource {
 public:
  StrongestPixels(SurfacePtr surface, const ImagePtr& map)
      : surface_(std::move(surface)), map_(materialized(nearest_at_size(map, surface_->exemplar.size()))) {}

  void read(const Rect& region, float* out) const override {
    const int channels = map_->channels();
    for (int y = region.y; y < region.bottom(); y++)
      for (int x = region.x; x < region.right(); x++) {
        const std::array<GridVertex, 3> vertices = surface_->around(x, y);
        const GridVertex& strongest = *std::ranges::max_element(vertices, {}, &GridVertex::weight);
        out = std::copy_n(map_->in_memory() + surface_->exemplar.sample(strongest) * channels, channels, out);
      }
  }

 private:
  SurfacePtr surface_;
  ImagePtr map_;
};

Digest recipe_of(const Material& exemplar, const NoiseByExample& o, const std::string& map) {
  Hasher h;
  h.add("noise_by_example").add(exemplar.digest()).add(map).add(o.cell).add(int64_t(o.seed)).add(o.exemplar_tiles);
  h.add(o.origin[0]).add(o.origin[1]).add(o.surface.wraps_x).add(o.surface.wraps_y);
  h.add(o.surface.size.width).add(o.surface.size.height);
  return h.digest();
}

}  // namespace

int largest_cell(Size exemplar, bool tiles) {
  const int side = std::min(exemplar.width, exemplar.height);
  return std::max(1, tiles ? side : (side - 1) / 2);
}

MaterialPtr noise_by_example(const Material& exemplar, const NoiseByExample& options, const Task& task) {
  require_one_shape("material", exemplar);
  const auto surface =
      std::make_shared<const NoiseSurface>(NoiseSurface{.exemplar{exemplar, options.exemplar_tiles, options.cell, task},
                                                        .grid{options.cell, options.surface, options.seed},
                                                        .origin = options.origin});
  std::vector<Map> maps;
  for (size_t i = 0; i < exemplar.maps().size(); i++) {
    const auto& [name, image] = exemplar.maps()[i];
    ImageInfo info = image->info();
    info.size = options.size;
    std::shared_ptr<const PixelSource> pixels;
    if (blends_samples(info))
      pixels = std::make_shared<BlendedPixels>(surface, info, i);
    else
      pixels = std::make_shared<StrongestPixels>(surface, image);
    maps.push_back({name, Image::computed(info, recipe_of(exemplar, options, name), std::move(pixels))});
  }
  const Size of = exemplar.size();
  return Material::make(
      exemplar.name(), std::move(maps),
      exemplar.metres() * std::array{double(options.size.width) / of.width, double(options.size.height) / of.height});
}

}  // namespace terrazzo
