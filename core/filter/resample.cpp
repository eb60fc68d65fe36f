#include "core/filter/resample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/base/portable_math.h"
#include "core/image/pixel_space.h"
#include "core/numeric/gaussian.h"

namespace terrazzo {

namespace {

void make_sum_one(std::vector<double>& weights, Taps& taps) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  taps.weights.resize(weights.size());
  std::transform(weights.begin(), weights.end(), taps.weights.begin(), [sum](double w) { return float(w / sum); });
}

AxisFilter copying(const std::function<int(int)>& position) {
  return {[position](int i) { return Taps{position(i), {1.0f}}; }, true, false};
}

/// sin(pi x) / (pi x).
float sinc(float x) {
  return std::abs(x) < 1e-4f ? 1 : float(portable::sin_turns(x / 2.0) / (3.14159265358979324 * x));
}

/// The cubic of Mitchell & Netravali (Reconstruction filters in computer graphics, 1988), B = C = 1/3.
float mitchell(float x) {
  const float x2 = x * x;
  if (x < 1) return (7 * x * x2 - 12 * x2 + 16.0f / 3) / 6;
  return x < 2 ? (-7.0f / 3 * x * x2 + 12 * x2 - 20 * x + 32.0f / 3) / 6 : 0;
}

/// A kernel, its reach to either side, and its value `at` a distance of 0 or more from its centre.
struct Kernel {
  const char* name;
  float reach;
  float (*at)(float distance);
};
constexpr std::array kernels = {
    Kernel{"box", 0.5f, [](float x) { return x <= 0.5f ? 1.0f : 0.0f; }},
    Kernel{"triangle", 1, [](float x) { return std::max(0.0f, 1 - x); }},
    Kernel{"mitchell", 2, mitchell},
    Kernel{"lanczos3", 3, [](float x) { return x < 3 ? sinc(x) * sinc(x / 3) : 0.0f; }},
};

const Kernel& kernel_of(const std::string& name) {
  return *std::ranges::find_if(kernels, [&](const Kernel& k) { return k.name == name; });
}

std::vector<Taps> taps_of(const AxisFilter& filter, int first, int count) {
  std::vector<Taps> taps(count);
  for (int i = 0; i < count; i++) taps[i] = filter.taps(first + i);
  return taps;
}

/// The source positions that the taps read: the first and one past the last.
std::pair<int, int> span_of(const std::vector<Taps>& taps) {
  int first = taps.front().first, last = first;
  for (const Taps& t : taps) {
    first = std::min(first, t.first);
    last = std::max(last, t.first + int(t.weights.size()));
  }
  return {first, last};
}

template <int channels>
void filter_row(const float* in, int left, const std::vector<Taps>& taps, float* out) {
  for (const Taps& t : taps) {
    const float* p = in + size_t(t.first - left) * channels;
    float sum[channels] = {};
    for (const float weight : t.weights)
      for (int c = 0; c < channels; c++) sum[c] += weight * *p++;
    out = std::copy_n(sum, channels, out);
  }
}

void filter_row(const float* in, int left, int channels, const std::vector<Taps>& taps, float* out) {
  constexpr std::array by_channels = {filter_row<1>, filter_row<2>, filter_row<3>, filter_row<4>};
  by_channels[channels - 1](in, left, taps, out);
}

void add_weighted(const float* in, float weight, size_t count, float* out) {
  for (size_t i = 0; i < count; i++) out[i] += weight * in[i];
}

/// The span of `count` results: the taps of the first and the last include all others.
std::pair<int, int> span_between(const AxisFilter& filter, int first, int count) {
  return span_of({filter.taps(first), filter.taps(first + count - 1)});
}

/// The part of the source from which rows are filtered; may lie outside it.
Rect around_in_rows(const AxisFilter& filter, const Rect& region) {
  const auto [left, right] = span_between(filter, region.x, region.width);
  return {left, region.y, right - left, region.height};
}

Rect around_in_columns(const AxisFilter& filter, const Rect& region) {
  const auto [top, bottom] = span_between(filter, region.y, region.height);
  return {region.x, top, region.width, bottom - top};
}

/// `to_average`, if given, describes the source: it is averaged in linear light.
void filter_rows(const PixelView& source, const AxisFilter& filter, Outside outside, const Rect& region,
                 const ImageInfo* to_average, float* out) {
  const int channels = source.channels();
  const std::vector<Taps> taps = taps_of(filter, region.x, region.width);
  const auto [left, right] = span_of(taps);
  const Rect from{left, region.y, right - left, region.height};
  std::vector<float> pixels = read_padded(source, from, outside);
  if (to_average) to_linear(*to_average, pixels.data(), from.area());
  const size_t row_values = size_t(region.width) * channels;
  for (int y = 0; y < region.height; y++) {
    const float* in = &pixels[size_t(y) * from.width * channels];
    if (!filter.slides) {
      filter_row(in, left, channels, taps, out + y * row_values);
      continue;
    }
    std::fill_n(out + y * row_values, row_values, 0.0f);
    for (const float weight : taps.front().weights) {
      add_weighted(in, weight, row_values, out + y * row_values);
      in += channels;
    }
  }
}

void filter_columns(const PixelView& source, const AxisFilter& filter, Outside outside, const Rect& region,
                    float* out) {
  const std::vector<Taps> taps = taps_of(filter, region.y, region.height);
  const auto [top, bottom] = span_of(taps);
  const std::vector<float> pixels = read_padded(source, {region.x, top, region.width, bottom - top}, outside);
  const size_t row_values = size_t(region.width) * source.channels();
  std::fill_n(out, row_values * region.height, 0.0f);
  for (int y = 0; y < region.height; y++)
    for (size_t t = 0; t < taps[y].weights.size(); t++)
      add_weighted(&pixels[(taps[y].first - top + t) * row_values], taps[y].weights[t], row_values,
                   out + y * row_values);
}

}  // namespace

const std::vector<std::string>& scaling_filter_names() {
  static const std::vector<std::string> names = {"auto", "nearest", "box", "triangle", "mitchell", "lanczos3"};
  return names;
}

AxisFilter scaling_filter(const std::string& name, int from, int to) {
  if (from == to) return copying([](int i) { return i; });
  if (name == "nearest")
    return copying([from, to](int i) { return int((int64_t{2} * i + 1) * from / (int64_t{2} * to)); });
  const std::string kernel_name = name != "auto" ? name : to < from ? "lanczos3" : "mitchell";
  const auto taps_at = [from, to, kernel = kernel_of(kernel_name)](int i) {
    const double ratio = double(from) / to, spread = std::max(1.0, ratio);
    const double centre = (i + 0.5) * ratio - 0.5, reach = kernel.reach * spread;
    Taps taps{int(std::ceil(centre - reach)), {}};
    std::vector<double> weights;
    for (int p = taps.first; p <= centre + reach; p++)
      weights.push_back(kernel.at(std::abs(float((p - centre) / spread))));
    make_sum_one(weights, taps);
    return taps;
  };
  return {taps_at, false, false};
}

AxisFilter gaussian_filter(double sigma) {
  if (sigma <= 0) return scaling_filter("nearest", 1, 1);
  const int reach = int(std::ceil(3 * sigma));
  const Taps kernel{-reach, gaussian_kernel(sigma, reach)};
  return {[kernel](int i) { return Taps{kernel.first + i, kernel.weights}; }, false, true};
}

ImagePtr filtered(const ImagePtr& source, const ImageInfo& info, const Digest& recipe, const AxisFilter& horizontal,
                  const AxisFilter& vertical, Outside outside) {
  const bool copies = horizontal.copies && vertical.copies;
  ImageInfo between;
  between.size = {info.size.width, source->height()};
  between.channels = info.channels;
  Hasher rows_recipe;
  rows_recipe.add("filtered horizontally").add(recipe);
  const Size from = source->size();
  Operation across{.sources = {source}, .compute = {}, .work = double(horizontal.taps(0).weights.size())};
  across.reads = [=](size_t, const Rect& region) {
    return padded_parts(from, around_in_rows(horizontal, region), outside);
  };
  across.compute = [=, given = source->info()](std::span<const PixelView> in, const Rect& region, float* out) {
    filter_rows(in[0], horizontal, outside, region, copies ? nullptr : &given, out);
  };
  const ImagePtr rows = Image::computed(between, rows_recipe.digest(), std::move(across));
  Operation down{.sources = {rows}, .compute = {}, .work = double(vertical.taps(0).weights.size())};
  down.reads = [=, size = between.size](size_t, const Rect& region) {
    return padded_parts(size, around_in_columns(vertical, region), outside);
  };
  down.compute = [=](std::span<const PixelView> in, const Rect& region, float* out) {
    filter_columns(in[0], vertical, outside, region, out);
    if (!copies) to_stored(info, out, region.area());
  };
  return Image::computed(info, recipe, std::move(down));
}

ImagePtr resampled(const ImagePtr& source, Size size, const std::string& filter, Outside outside,
                   const Digest& recipe) {
  if (size == source->size()) return source;
  ImageInfo info = source->info();
  info.size = size;
  const std::string name = filter == "auto" && !can_be_averaged(info) ? "nearest" : filter;
  return filtered(source, info, recipe, scaling_filter(name, source->width(), size.width),
                  scaling_filter(name, source->height(), size.height), outside);
}

ImagePtr numbers_at_size(const ImagePtr& image, Size size, const Task& task) {
  ImageInfo info = image->info();
  info.semantic = Semantic::data;
  info.color_space = "raw";
  const ImagePtr plain = Image::redescribed(image, info);
  if (image->size() == size) return materialized(plain, task);
  info.size = size;
  const AxisFilter across = scaling_filter("triangle", image->width(), size.width);
  const AxisFilter down = scaling_filter("triangle", image->height(), size.height);
  return materialized(filtered(plain, info, Digest{}, across, down, Outside::clamp), task);
}

}  // namespace terrazzo
