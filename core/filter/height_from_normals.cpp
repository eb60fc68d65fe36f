#include "core/filter/height_from_normals.h"

#include <algorithm>
#include <numeric>

#include <tbb/parallel_for.h>

#include "core/numeric/screened_poisson.h"

namespace terrazzo {

namespace {

constexpr float steepest = 256;
/// Multigrid cycles. Each leaves less than half of the error (screened_poisson_test.cpp); after 12, an error of 1e-5 of
/// the relief remains at 4096x4096 pixels.
constexpr int cycles = 12;
/// The largest part of a surface's longest wave that may be lost to the screening, which keeps the equation regular.
constexpr double longest_loses = 1e-5;
constexpr int border = 2;  ///< pixels around a region whose slopes are read

/// The weights by which the difference between neighbouring pixels is computed from slopes.
struct RiseFilter {
  float near;  ///< weight of the slopes at either end
  float far;   ///< of the slopes one pixel further
  float side;  ///< weight that the slopes on either side subtract from each of these
};

/// Along the axis the weights are exact for cubics, for the derivative or a filter's central difference. Across it they
/// undo the filter's smoothing up to third order.
RiseFilter rise_filter(std::optional<SlopeFilter> measured) {
  if (!measured) return {13.0f / 24, -1.0f / 24, 0};
  const float side = *measured == SlopeFilter::central ? 0.0f : *measured == SlopeFilter::sobel ? 0.25f : 0.1875f;
  return {0.625f, -0.125f, side};
}

/// One component of the slopes, with a border around the image.
class SlopePlane {
 public:
  explicit SlopePlane(Size size)
      : size_(size), stride_(size.width + 2 * border), values_(size_t(stride_) * size_t(size.height + 2 * border)) {}
  /// Coordinates may lie in the border.
  float* at(int x, int y) { return &values_[size_t(y + border) * size_t(stride_) + size_t(x + border)]; }
  const float* at(int x, int y) const { return &values_[size_t(y + border) * size_t(stride_) + size_t(x + border)]; }
  int stride() const { return stride_; }

  /// Extrapolates the first and the last of `count` slopes from the two next to them; `step`: their distance in memory.
  static void continue_line(float* first, int count, ptrdiff_t step) {
    if (count < 4) return;
    float* last = first + (count - 1) * step;
    *first = 2 * first[step] - first[2 * step];
    *last = 2 * last[-step] - last[-2 * step];
  }

  /// Fills the border. Without wrapping, slopes are extrapolated linearly along their axis; across it they are
  /// constant, like those of filters that repeat the surface's border pixels.
  void fill_border(bool wraps, bool measures_x) {
    const Beyond along = wraps ? Beyond::other_side : Beyond::line, across = wraps ? Beyond::other_side : Beyond::same;
    for (int y = 0; y < size_.height; y++) extend(at(0, y), size_.width, 1, measures_x ? along : across);
    for (int x = -border; x < size_.width + border; x++)
      extend(at(x, 0), size_.height, stride_, measures_x ? across : along);
  }

 private:
  enum class Beyond : uint8_t { other_side, line, same };

  static void extend(float* first, int count, ptrdiff_t step, Beyond beyond) {
    float* last = first + (count - 1) * step;
    const bool grows = beyond == Beyond::line && count > 1, wraps = beyond == Beyond::other_side;
    const float before = grows ? *first - first[step] : 0.0f, after = grows ? *last - last[-step] : 0.0f;
    for (int i = 1; i <= border; i++) {
      first[-i * step] = wraps ? first[wrap(-i, count) * step] : *first + float(i) * before;
      last[i * step] = wraps ? first[wrap(i - 1, count) * step] : *last + float(i) * after;
    }
  }

  Size size_;
  int stride_;
  std::vector<float> values_;
};

/// The slopes of a surface: its rise per pixel to the right and down the image.
struct Slopes {
  SlopePlane right, down;
};

Slopes slopes_of(const Image& normal, const IntegrationOptions& options, const Task& task) {
  const Size size = normal.size();
  Slopes slopes{SlopePlane(size), SlopePlane(size)};
  const int channels = normal.channels();
  for_each_strip(normal, [&](const Rect& strip, const float* pixels) {
    task.check();
    for (int y = strip.y; y < strip.bottom(); y++)
      for (int x = 0; x < size.width; x++, pixels += channels) {
        const Vector3f n = normalized(decode_normal(pixels, normal.info().normal_y));
        const float z = std::max(n.z(), 1 / steepest);
        *slopes.right.at(x, y) = -n.x() / z;
        *slopes.down.at(x, y) = n.y() / z;
      }
  });
  const bool wraps = options.outside == Outside::wrap;
  if (!wraps && options.filter) {
    // Filters see a flat surface beyond a border, and measure half of the slope across it.
    for (int y = 0; y < size.height; y++) SlopePlane::continue_line(slopes.right.at(0, y), size.width, 1);
    for (int x = 0; x < size.width; x++)
      SlopePlane::continue_line(slopes.down.at(x, 0), size.height, slopes.down.stride());
  }
  slopes.right.fill_border(wraps, true);
  slopes.down.fill_border(wraps, false);
  return slopes;
}

/// The rise from a pixel to the one `along` further in memory.
float rise(const float* slope, ptrdiff_t along, ptrdiff_t across, const RiseFilter& f) {
  const auto sharpened = [&](const float* p) { return (1 + 2 * f.side) * *p - f.side * (p[-across] + p[across]); };
  return f.near * (sharpened(slope) + sharpened(slope + along)) +
         f.far * (sharpened(slope - along) + sharpened(slope + 2 * along));
}

/// The right-hand side of the Poisson equation: the rise to a pixel minus the rise from it.
std::vector<float> forces_of(const Slopes& slopes, Size size, const IntegrationOptions& options) {
  const RiseFilter filter = rise_filter(options.filter);
  const bool wraps = options.outside == Outside::wrap;
  const ptrdiff_t stride = slopes.right.stride();
  std::vector<float> forces(size_t(size.area()));
  tbb::parallel_for(0, size.height, [&](int y) {
    float* out = &forces[size_t(y) * size_t(size.width)];
    const float *right = slopes.right.at(0, y), *down = slopes.down.at(0, y);
    for (int x = 0; x < size.width; x++, right++, down++) {
      float force = 0;
      if (wraps || x > 0) force += rise(right - 1, 1, stride, filter);
      if (wraps || x + 1 < size.width) force -= rise(right, 1, stride, filter);
      if (wraps || y > 0) force += rise(down - stride, stride, 1, filter);
      if (wraps || y + 1 < size.height) force -= rise(down, stride, 1, filter);
      out[x] = force;
    }
  });
  return forces;
}

double screen_of(Size size, double flatten) {
  constexpr double pi = 3.14159265358979324;
  const double longest = pi / std::max(size.width, size.height);
  return longest_loses * longest * longest + (flatten > 0 ? 1 / (flatten * flatten) : 0);
}

std::vector<float> without_mean(const ScreenedPoisson& surface, Size size) {
  std::vector<float> heights(size_t(size.area()));
  double sum = 0;
  for (int y = 0; y < size.height; y++) {
    std::copy_n(surface.values(y), size.width, &heights[size_t(y) * size_t(size.width)]);
    sum = std::accumulate(surface.values(y), surface.values(y) + size.width, sum);
  }
  const float mean = float(sum / double(size.area()));
  for (float& h : heights) h -= mean;
  return heights;
}

}  // namespace

std::vector<float> heights_from_normals(const Image& normal, const IntegrationOptions& options, const Task& task) {
  const Size size = normal.size();
  const bool wraps = options.outside == Outside::wrap;
  const std::vector<float> forces = forces_of(slopes_of(normal, options, task), size, options);
  ScreenedPoisson surface(CellAxis::of_pixels(size.width, wraps), CellAxis::of_pixels(size.height, wraps),
                          screen_of(size, options.flatten));
  for (int i = 0; i < cycles; i++) {
    task.progress(double(i) / cycles);
    for (int y = 0; y < size.height; y++)
      std::copy_n(&forces[size_t(y) * size_t(size.width)], size.width, surface.forces(y));
    surface.improve(task);
  }
  surface.finish();
  return without_mean(surface, size);
}

}  // namespace terrazzo
