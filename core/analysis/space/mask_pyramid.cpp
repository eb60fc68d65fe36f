#include "core/analysis/space/mask_pyramid.h"

#include <algorithm>

#include "core/analysis/space/padded_level.h"
#include "core/base/error.h"
#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct MaskPyramidTuning {
  double least_part = 0.25;
};
const Tunable<MaskPyramidTuning> mask_pyramid_tuning(
    "mask_pyramid", {
                        {&MaskPyramidTuning::least_part, "least_part", "share of what the mask allows",
                         "that must be left at coarse levels for what lies near its border to be left out. "
                         "Higher: all of it is used; lower: what is masked shows less",
                         "not measured: taken over from the code before constants were listed", 0, 1},
                    });

using Pixels = std::vector<uint8_t>;

/// Keeps the pixels around which a window sees kept pixels only.
Pixels eroded(const Pixels& in, Size size, bool wraps) {
  constexpr int radius = 2;  // a comparison window's
  const auto pass = [&](const Pixels& from, int dx, int dy) {
    Pixels out(from.size());
    for (int y = 0; y < size.height; y++)
      for (int x = 0; x < size.width; x++) {
        bool all = true;
        for (int i = -radius; i <= radius && all; i++) {
          const int u = x + i * dx, v = y + i * dy;
          const bool inside = u >= 0 && v >= 0 && u < size.width && v < size.height;
          all = (inside || wraps) && from[size_t(wrap(v, size.height)) * size.width + wrap(u, size.width)];
        }
        out[size_t(y) * size.width + x] = all;
      }
    return out;
  };
  return pass(pass(in, 1, 0), 0, 1);
}

}  // namespace

std::vector<uint8_t> allowed_pixels(const Features& features) {
  const ImagePtr& mask = features.mask();
  if (!mask) return {};
  Pixels out;
  out.reserve(size_t(mask->size().area()));
  for_each_strip(*mask, [&](const Rect& r, const float* v) {
    for (int64_t i = 0; i < r.area(); i++) out.push_back(v[i * mask->channels()] > 0.5f);
  });
  if (std::find(out.begin(), out.end(), 1) == out.end())
    throw Error("mask",
                "the mask allows no pixel of the exemplar: it is nowhere above 0.5 (white). If white marks what to "
                "leave out, invert it with \"levels\"; if it comes from holes to fill, they cover everything, and "
                "nothing is left to fill them with");
  return out;
}

std::vector<uint8_t> usable_pixels(const std::vector<uint8_t>& allowed, Size finest, int level, bool wraps) {
  if (allowed.empty()) return {};
  const int block = 1 << level;
  const Size size{(finest.width + block - 1) / block, (finest.height + block - 1) / block};
  std::vector<int> counts(size_t(size.area()));
  for (int y = 0; y < finest.height; y++)
    for (int x = 0; x < finest.width; x++)
      counts[size_t(y / block) * size.width + x / block] += allowed[size_t(y) * finest.width + x];
  Pixels any(counts.size()), whole(counts.size());
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const size_t at = size_t(y) * size.width + x;
      any[at] = counts[at] > 0;
      whole[at] = counts[at] == std::min(block, finest.width - x * block) * std::min(block, finest.height - y * block);
    }
  const auto enough = [least = mask_pyramid_tuning->least_part * double(std::count(any.begin(), any.end(), 1))](
                          const Pixels& p) { return double(std::count(p.begin(), p.end(), 1)) >= least; };
  Pixels inner = eroded(whole, size, wraps);
  if (enough(inner)) return inner;
  return enough(whole) ? whole : any;
}

}  // namespace terrazzo
