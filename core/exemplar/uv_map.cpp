#include "core/exemplar/uv_map.h"

#include <algorithm>
#include <stdexcept>

namespace terrazzo {

UvMapPtr UvMap::make(Size size, Size exemplar, std::vector<ExemplarPixel> pixels, UvWraps wraps,
                     FingerprintPtr fingerprint) {
  if (pixels.size() != size_t(size.area())) throw std::logic_error("one exemplar pixel per output pixel");
  if (std::any_of(pixels.begin(), pixels.end(),
                  [&](ExemplarPixel p) { return p.x >= exemplar.width || p.y >= exemplar.height; }))
    throw std::logic_error("the uv map points outside its exemplar");
  Hasher h;
  h.add("uv map").add(size.width).add(size.height).add(exemplar.width).add(exemplar.height);
  h.add(wraps.x).add(wraps.y).add(wraps.exemplar);
  h.bytes(pixels.data(), pixels.size() * sizeof(ExemplarPixel));
  if (fingerprint) fingerprint->add_to(h);
  auto map = std::shared_ptr<UvMap>(new UvMap);
  map->size_ = size;
  map->exemplar_ = exemplar;
  map->wraps_ = wraps;
  map->pixels_ = std::move(pixels);
  map->fingerprint_ = std::move(fingerprint);
  map->digest_ = h.digest();
  return map;
}

void UvMap::read(const Rect& r, ExemplarPixel* out) const {
  for (int y = 0; y < r.height; y++)
    std::copy_n(&pixels_[size_t(r.y + y) * size_.width + r.x], r.width, out + size_t(y) * r.width);
}

}  // namespace terrazzo
