#include "core/material/variants.h"

#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/base/portable_math.h"
#include "core/filter/resample.h"
#include "core/image/image_ops.h"
#include "core/image/pixel_space.h"

namespace terrazzo {

namespace {

/// Turns encoded vectors of the plane, counter-clockwise for y pointing up.
void turn_vectors(const ImageInfo& info, float cosine, float sine, float* pixels, int64_t count) {
  const float up = info.normal_y == NormalY::up ? 1.0f : -1.0f;
  for (int64_t i = 0; i < count; i++, pixels += info.channels) {
    const float x = pixels[0] * 2 - 1, y = (pixels[1] * 2 - 1) * up;
    pixels[0] = (cosine * x - sine * y) * 0.5f + 0.5f;
    pixels[1] = (sine * x + cosine * y) * up * 0.5f + 0.5f;
  }
}

bool holds_vectors(const ImageInfo& info) {
  return info.semantic == Semantic::normal && info.channels >= 2;
}

Hasher& add_size(Hasher& h, Size size) {
  return h.add(size.width).add(size.height);
}

// --- Scaling

double mean_of(const Image& image) {
  double sum = 0;
  for_each_strip(image, [&](const Rect& r, const float* v) {
    for (int64_t i = 0; i < r.area() * image.channels(); i++) sum += double(v[i]);
  });
  return sum / (double(image.size().area()) * image.channels());
}

/// Heights as far from their mean as on a body `factor` times as large.
ImagePtr deepened(const ImagePtr& height, double factor) {
  const float mean = float(mean_of(*height)), by = float(factor);
  const ImageInfo info = height->info();
  const Digest recipe = Hasher().add("deepened").add(height->digest()).add(factor).digest();
  return pixel_by_pixel(info, recipe, {height}, [=](auto in, float* out, int64_t count) {
    for (int64_t i = 0; i < count * info.channels; i++) out[i] = mean + (in[0][i] - mean) * by;
    keep_in_range(info, out, count);
  });
}

ImagePtr scaled(const ImagePtr& map, Size size, double factor, Outside outside) {
  Hasher recipe;
  add_size(recipe.add("scaled").add(map->digest()).add(int(outside)), size);
  const ImagePtr image = resampled(map, size, "auto", outside, recipe.digest());
  return map->info().semantic == Semantic::height ? deepened(image, factor) : image;
}

// --- Mirroring and quarter turns

struct Flip {
  bool mirror_x = false, mirror_y = false;
  int quarters = 0;  ///< counter-clockwise, after mirroring

  bool changes() const { return mirror_x || mirror_y || quarters; }
  Size target(Size s) const { return quarters % 2 ? Size{s.height, s.width} : s; }
  /// The pixel of a source of size `s` that pixel (x, y) of the result shows.
  std::array<int, 2> source(int x, int y, Size s) const {
    int u = quarters == 0 ? x : quarters == 1 ? s.width - 1 - y : quarters == 2 ? s.width - 1 - x : y;
    int v = quarters == 0 ? y : quarters == 1 ? x : quarters == 2 ? s.height - 1 - y : s.height - 1 - x;
    if (mirror_x) u = s.width - 1 - u;
    if (mirror_y) v = s.height - 1 - v;
    return {u, v};
  }
};

void flip_vectors(const ImageInfo& info, const Flip& flip, float* pixels, int64_t count) {
  for (int64_t i = 0; i < count; i++) {
    float* p = pixels + i * info.channels;
    if (flip.mirror_x) p[0] = 1 - p[0];
    if (flip.mirror_y) p[1] = 1 - p[1];
  }
  constexpr float cosines[4] = {1, 0, -1, 0}, sines[4] = {0, 1, 0, -1};
  if (flip.quarters) turn_vectors(info, cosines[flip.quarters], sines[flip.quarters], pixels, count);
}

Rect before_flip(const Flip& flip, const Rect& region, Size size) {
  const auto a = flip.source(region.x, region.y, size);
  const auto b = flip.source(region.right() - 1, region.bottom() - 1, size);
  return {std::min(a[0], b[0]), std::min(a[1], b[1]), std::abs(a[0] - b[0]) + 1, std::abs(a[1] - b[1]) + 1};
}

void read_flipped(const PixelView& map, const ImageInfo& info, const Flip& flip, const Rect& region, float* out) {
  const Rect from = before_flip(flip, region, map.size());
  const std::vector<float> pixels = map.read(from);
  const int n = map.channels();
  float* o = out;
  for (int y = region.y; y < region.bottom(); y++)
    for (int x = region.x; x < region.right(); x++) {
      const auto [u, v] = flip.source(x, y, map.size());
      o = std::copy_n(&pixels[(size_t(v - from.y) * from.width + (u - from.x)) * n], n, o);
    }
  if (holds_vectors(info)) flip_vectors(info, flip, out, region.area());
}

ImagePtr flipped(const ImagePtr& map, const Flip& flip) {
  ImageInfo info = map->info();
  info.size = flip.target(map->size());
  const Digest recipe =
      Hasher().add("flipped").add(map->digest()).add(flip.mirror_x).add(flip.mirror_y).add(flip.quarters).digest();
  const auto reads = [flip, size = map->size()](size_t, const Rect& region) {
    return std::vector<Rect>{before_flip(flip, region, size)};
  };
  const auto compute = [flip, given = map->info()](std::span<const PixelView> in, const Rect& region, float* out) {
    read_flipped(in[0], given, flip, region, out);
  };
  return Image::computed(info, recipe, {.sources = {map}, .reads = reads, .compute = compute, .work = 4});
}

// --- Rotation by any angle

/// From pixels of a rotated map to pixels of its source.
struct Affine {
  double x0 = 0, xx = 0, xy = 0, y0 = 0, yx = 0, yy = 0;
  std::array<double, 2> operator()(double x, double y) const { return {x0 + xx * x + xy * y, y0 + yx * x + yy * y}; }
};

struct Turn {
  double degrees = 0;
  double cosine = 1, sine = 0;
  Size from, to;  ///< of the material

  Affine affine(Size source, Size target) const {
    // Pixel centres, in the material's pixels around its middle, and back.
    const double step_x = double(to.width) / target.width, step_y = double(to.height) / target.height;
    const double left = 0.5 * step_x - 0.5 * to.width, top = 0.5 * step_y - 0.5 * to.height;
    const double fit_x = double(source.width) / from.width, fit_y = double(source.height) / from.height;
    return {fit_x * (0.5 * from.width + cosine * left - sine * top) - 0.5,
            fit_x * cosine * step_x,
            -fit_x * sine * step_y,
            fit_y * (0.5 * from.height + sine * left + cosine * top) - 0.5,
            fit_y * sine * step_x,
            fit_y * cosine * step_y};
  }
};

/// Catmull and Rom's cubic through the four pixels around a place: Keys, Cubic convolution interpolation for digital
/// image processing, 1981, with a = -1/2.
std::array<float, 4> cubic_weights(double fraction) {
  const float t = float(fraction);
  return {((-0.5f * t + 1) * t - 0.5f) * t, (1.5f * t - 2.5f) * t * t + 1, ((-1.5f * t + 2) * t + 0.5f) * t,
          (0.5f * t - 0.5f) * t * t};
}

/// Source pixels around a tile's, ready to be averaged.
struct Block {
  Rect rect;
  int channels;
  std::vector<float> pixels;
  const float* at(int64_t x, int64_t y) const {
    return &pixels[size_t((y - rect.y) * rect.width + (x - rect.x)) * channels];
  }
};

/// The part of the source from which a tile is averaged; may lie outside it.
Rect rect_around(const Affine& affine, const Rect& tile) {
  double low[2] = {1e30, 1e30}, high[2] = {-1e30, -1e30};
  for (const int x : {tile.x, tile.right() - 1})
    for (const int y : {tile.y, tile.bottom() - 1}) {
      const std::array<double, 2> p = affine(x, y);
      for (int i = 0; i < 2; i++) {
        low[i] = std::min(low[i], p[i]);
        high[i] = std::max(high[i], p[i]);
      }
    }
  const int left = int(portable::floor_int(low[0])) - 2, top = int(portable::floor_int(low[1])) - 2;
  return {left, top, int(portable::floor_int(high[0])) + 4 - left, int(portable::floor_int(high[1])) + 4 - top};
}

void sample(const Block& block, double x, double y, bool interpolated, float* out) {
  if (!interpolated) {
    std::copy_n(block.at(portable::floor_int(x + 0.5), portable::floor_int(y + 0.5)), block.channels, out);
    return;
  }
  const int64_t left = portable::floor_int(x), top = portable::floor_int(y);
  const std::array<float, 4> across = cubic_weights(x - double(left)), down = cubic_weights(y - double(top));
  std::fill_n(out, block.channels, 0.0f);
  for (int j = 0; j < 4; j++) {
    const float* p = block.at(left - 1, top + j - 1);
    for (int i = 0; i < 4; i++)
      for (int c = 0; c < block.channels; c++) out[c] += across[i] * down[j] * *p++;
  }
}

/// Calls `visit` for each of a region's square tiles: a rotated source covers a square with little waste.
void for_each_tile(const Rect& region, const std::function<void(const Rect&)>& visit) {
  constexpr int side = 128;
  for (int y = region.y; y < region.bottom(); y += side)
    for (int x = region.x; x < region.right(); x += side) visit(intersect({x, y, side, side}, region));
}

ImagePtr turned(const ImagePtr& map, const Turn& turn, Outside outside) {
  ImageInfo info = map->info();
  const int divisor = divisor_of(map->size(), turn.from);
  info.size = {turn.to.width / divisor, turn.to.height / divisor};
  Hasher recipe;
  add_size(recipe.add("turned").add(map->digest()).add(turn.degrees).add(int(outside)), turn.from);
  const Affine affine = turn.affine(map->size(), info.size);
  Operation operation{.sources = {map}, .compute = {}, .work = 20};
  operation.reads = [=, size = map->size()](size_t, const Rect& region) {
    std::vector<Rect> parts;
    for_each_tile(region, [&](const Rect& tile) {
      const std::vector<Rect> of_tile = padded_parts(size, rect_around(affine, tile), outside);
      parts.insert(parts.end(), of_tile.begin(), of_tile.end());
    });
    return parts;
  };
  operation.compute = [=](std::span<const PixelView> in, const Rect& region, float* out) {
    const bool interpolated = can_be_averaged(info);
    for_each_tile(region, [&](const Rect& tile) {
      const Rect around = rect_around(affine, tile);
      Block block{around, info.channels, read_padded(in[0], around, outside)};
      if (interpolated) to_linear(info, block.pixels.data(), block.rect.area());
      for (int y = tile.y; y < tile.bottom(); y++) {
        float* row = out + (size_t(y - region.y) * region.width + (tile.x - region.x)) * info.channels;
        for (int x = tile.x; x < tile.right(); x++) {
          const auto [u, v] = affine(x, y);
          sample(block, u, v, interpolated, row + size_t(x - tile.x) * info.channels);
        }
        if (holds_vectors(info)) turn_vectors(info, float(turn.cosine), float(turn.sine), row, tile.width);
        if (interpolated) to_stored(info, row, tile.width);
      }
    });
  };
  return Image::computed(info, recipe.digest(), std::move(operation));
}

/// 1 where a rotated material shows points between pixel centres of the exemplar, not beyond its border.
ImagePtr coverage(const Turn& turn) {
  const ImageInfo info{.size = turn.to, .channels = 1, .semantic = Semantic::mask, .depth = Depth::u8};
  Hasher recipe;
  add_size(recipe.add("coverage").add(turn.degrees), turn.from);
  const Affine affine = turn.affine(turn.from, turn.to);
  const double right = turn.from.width - 1, bottom = turn.from.height - 1;
  return Image::computed(info, recipe.digest(), [=](const Rect& region, float* out) {
    for (int y = region.y; y < region.bottom(); y++)
      for (int x = region.x; x < region.right(); x++) {
        const auto [u, v] = affine(x, y);
        *out++ = u >= 0 && u <= right && v >= 0 && v <= bottom ? 1.0f : 0.0f;
      }
  });
}

ImagePtr both(const ImagePtr& a, const ImagePtr& b) {
  const Digest recipe = Hasher().add("both").add(a->digest()).add(b->digest()).digest();
  return pixel_by_pixel(b->info(), recipe, {a, b}, [](auto in, float* out, int64_t count) {
    for (int64_t i = 0; i < count; i++) out[i] = in[0][i] > 0.5f && in[1][i] > 0.5f ? 1.0f : 0.0f;
  });
}

// --- Whole exemplars

/// The least common multiple of the factors by which maps are smaller: sizes that are multiples of it fit every map.
int common_divisor_multiple(const Material& material) {
  int multiple = 1;
  for (const Map& m : material.maps()) multiple = std::lcm(multiple, divisor_of(m.image->size(), material.size()));
  return multiple;
}

Exemplar with_each(const Exemplar& exemplar, const std::function<ImagePtr(const ImagePtr&)>& change) {
  std::vector<Map> maps = exemplar.material->maps();
  for (Map& m : maps) m.image = change(m.image);
  return {Material::make(exemplar.material->name(), std::move(maps)), exemplar.mask ? change(exemplar.mask) : nullptr};
}

Exemplar scaled(const Exemplar& exemplar, double scale, Outside outside) {
  const Size size = exemplar.material->size();
  const int multiple = common_divisor_multiple(*exemplar.material);
  const auto rounded = [&](int side) {
    return multiple * std::max(1, int(portable::floor_int(side * scale / multiple + 0.5)));
  };
  const Size target{rounded(size.width), rounded(size.height)};
  return with_each(exemplar, [&](const ImagePtr& map) {
    const int divisor = divisor_of(map->size(), size);
    return scaled(map, {target.width / divisor, target.height / divisor}, scale, outside);
  });
}

Exemplar turned(const Exemplar& exemplar, double degrees, Outside outside) {
  const Size size = exemplar.material->size();
  const int multiple = common_divisor_multiple(*exemplar.material);
  Turn turn{degrees, portable::cos_turns(degrees / 360), portable::sin_turns(degrees / 360), size, {}};
  const double c = std::fabs(turn.cosine), s = std::fabs(turn.sine);
  const auto rounded_up = [&](double side) { return multiple * int(std::ceil(side / multiple - 1e-6)); };
  turn.to = {rounded_up(size.width * c + size.height * s), rounded_up(size.width * s + size.height * c)};
  Exemplar out = with_each(exemplar, [&](const ImagePtr& map) { return turned(map, turn, outside); });
  if (out.mask) out.mask = nearest_at_size(out.mask, turn.to);
  if (outside == Outside::wrap) return out;
  out.mask = out.mask ? both(out.mask, coverage(turn)) : coverage(turn);
  return out;
}

}  // namespace

int divisor_of(Size map, Size material) {
  const int d = material.width / std::max(1, map.width);
  return d > 0 && map.width * d == material.width && map.height * d == material.height ? d : 1;
}

Exemplar varied(const Exemplar& exemplar, const Variant& variant, Outside outside) {
  Exemplar out = exemplar;
  if (variant.scale != 1) out = scaled(out, variant.scale, outside);
  const int64_t quarters = portable::floor_int(variant.rotation / 90 + 0.5);
  const Flip flip{variant.mirror_x, variant.mirror_y, int(quarters & 3)};
  if (flip.changes()) out = with_each(out, [&](const ImagePtr& map) { return flipped(map, flip); });
  const double rest = variant.rotation - 90.0 * double(quarters);
  return rest == 0 ? out : turned(out, rest, outside);
}

}  // namespace terrazzo
