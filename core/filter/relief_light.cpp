#include "core/filter/relief_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/portable_math.h"
#include "core/base/tuning.h"
#include "core/filter/linear_colors.h"
#include "core/image/image_ops.h"
#include "core/image/normal.h"
#include "core/numeric/linear_algebra.h"

namespace terrazzo {

namespace {

struct ReliefLightTuning {
  double least_explained = 0.02;
  double least_certainty = 10;
  double shade = 0.25;
  double usual_slope = 0.35;
};
const Tunable<ReliefLightTuning> relief_light_tuning(
    "relief_light",
    {{&ReliefLightTuning::least_explained, "least_explained", "share of the variance",
      "higher: faint shading stays; lower: normals made from the colours themselves pass for light", "delight"},
     {&ReliefLightTuning::least_certainty, "least_certainty", "variances of the estimate",
      "higher: light must be found alike in all parts of the picture; lower: chance passes for light", "delight"},
     {&ReliefLightTuning::shade, "shade", "of a flat place's brightness",
      "brightness where no direct light falls. Higher: shadows stay darker; lower: their noise is raised", "delight",
      0.01, 1},
     {&ReliefLightTuning::usual_slope, "usual_slope", "root mean square",
      "of heights without normals. Higher: steep places differ less from gentle ones", "delight", 0.01, 10}});

constexpr int light_parts = 4;          ///< per side, in which the light is compared
constexpr int iterations = 8;           ///< of Gauss and Newton; five do
constexpr double strongest_slope = 4;   ///< a light 14 degrees above the surface, without any other
constexpr int most_per_side = 1024;     ///< pixels that are used
constexpr double darkest_pixel = 1e-3;  ///< linear; below, the noise of photographs decides
constexpr double least_slopes = 1e-6;   ///< variance of the normals' x and y; less is a flat map

struct Sample {
  float logarithm, x, y;
  int part;
};

/// Normal equations for the mean and both slopes.
struct Equations {
  MatrixXd matrix = MatrixXd::Zero(3, 3);
  VectorXd right = VectorXd::Zero(3);

  void operator+=(const Equations& other) {
    matrix += other.matrix;
    right += other.right;
  }
  void operator-=(const Equations& other) {
    matrix -= other.matrix;
    right -= other.right;
  }
  Vector3d solved() const {
    MatrixXd regular = matrix;
    for (int i = 0; i < 3; i++) regular(i, i) += 1e-9 * matrix(0, 0) + 1e-30;
    return solve_positive_definite(regular, right);
  }
};

std::vector<Sample> samples_of(const ImagePtr& color, const ImagePtr& opacity, const ImagePtr& normals,
                               const SlowLight& slow) {
  const Size size = color->size();
  const ImageInfo info{.size = size, .channels = 4, .semantic = Semantic::data};
  const int channels = normals->channels();
  const ImagePtr linear = linear_colors(color, opacity);
  const ImagePtr both =
      pixel_by_pixel(info, Hasher().add("relief light").add(linear->digest()).add(normals->digest()).digest(),
                     {linear, normals}, [=](auto in, float* out, int64_t count) {
                       const float* v = in[0];
                       for (int64_t i = 0; i < count; i++, v += 4, out += 4) {
                         const Vector3f n = normalized(decode_normal(in[1] + i * channels, NormalY::up));
                         out[0] = luminance(v[0], v[1], v[2]);
                         out[1] = n.x();
                         out[2] = n.y();
                         out[3] = std::isfinite(n.x()) && std::isfinite(n.y()) ? v[3] : 0;
                       }
                     });
  const int step = (std::max(size.width, size.height) - 1) / most_per_side + 1;
  std::vector<Sample> out;
  std::vector<double> row(size_t(size.width));
  for_each_strip(*both, [&](const Rect& r, const float* v) {
    for (int y = r.y; y < r.bottom(); y++, v += int64_t{4} * r.width) {
      if (y % step) continue;
      slow.logarithms(0, y, size.width, row.data());
      for (int x = 0; x < size.width; x += step) {
        const float* p = v + int64_t{4} * x;
        if (p[3] == 0) continue;
        const double logarithm = portable::log(std::max(double(p[0]), darkest_pixel)) - row[size_t(x)];
        const int part =
            int(int64_t{y} * light_parts / size.height * light_parts + int64_t{x} * light_parts / size.width);
        out.push_back({float(logarithm), p[1], p[2], part});
      }
    }
  });
  return out;
}

/// The equations of a step from `light` by the method of Gauss and Newton, for each part.
std::vector<Equations> equations_at(const std::vector<Sample>& samples, const ReliefLight& light, double mean) {
  std::vector<Equations> out(size_t(light_parts) * light_parts);
  const double shade = relief_light_tuning->shade;
  for (const Sample& s : samples) {
    const double bright = 1 + light.x * double(s.x) + light.y * double(s.y), shading = std::max(bright, shade);
    const double inverse = bright > shade ? 1 / bright : 0;
    const double error = double(s.logarithm) - mean - portable::log(shading);
    const std::array<double, 3> slopes = {1, double(s.x) * inverse, double(s.y) * inverse};
    Equations& e = out[size_t(s.part)];
    for (int i = 0; i < 3; i++) {
      e.right[i] += slopes[size_t(i)] * error;
      for (int j = 0; j < 3; j++) e.matrix(i, j) += slopes[size_t(i)] * slopes[size_t(j)];
    }
  }
  return out;
}

/// The squared length of the slopes over the variance of the estimate, by leaving out one part after the other
/// (jackknife).
double certainty(const std::vector<Equations>& of_parts, const Equations& all, const ReliefLight& light) {
  std::vector<Vector3d> without;
  Vector3d mean = Vector3d::Zero();
  for (const Equations& part : of_parts) {
    Equations others = all;
    others -= part;
    without.push_back(others.solved());
    mean += without.back() / double(of_parts.size());
  }
  double variance = 0;
  for (const Vector3d& v : without)
    for (int i = 1; i < 3; i++) variance += (v[i] - mean[i]) * (v[i] - mean[i]);
  variance *= double(of_parts.size() - 1) / double(of_parts.size());
  return (light.x * light.x + light.y * light.y) / std::max(variance, 1e-30);
}

/// The variance of log luminance, and of what is left of it; and the mean logarithm of the shading.
struct Fit {
  double variance = 0, left = 0, mean_logarithm = 0;
};

Fit fit_of(const std::vector<Sample>& samples, const ReliefLight& light) {
  double sum = 0, squares = 0, sum_left = 0, squares_left = 0, shadings = 0;
  for (const Sample& s : samples) {
    const double all = double(s.logarithm), shading = portable::log(light.shading(double(s.x), double(s.y)));
    sum += all;
    squares += all * all;
    sum_left += all - shading;
    squares_left += (all - shading) * (all - shading);
    shadings += shading;
  }
  const auto count = double(samples.size());
  return {squares / count - sum / count * (sum / count), squares_left / count - sum_left / count * (sum_left / count),
          shadings / count};
}

bool are_flat(const std::vector<Sample>& samples) {
  double x = 0, y = 0, squares = 0;
  for (const Sample& s : samples) {
    x += double(s.x);
    y += double(s.y);
    squares += double(s.x) * double(s.x) + double(s.y) * double(s.y);
  }
  const auto count = std::max(1.0, double(samples.size()));
  return squares / count - x / count * (x / count) - y / count * (y / count) < least_slopes;
}

}  // namespace

double ReliefLight::shading(double normal_x, double normal_y) const {
  return std::max(1 + x * normal_x + y * normal_y, relief_light_tuning->shade);
}

double ReliefLight::azimuth() const {
  const double degrees = portable::atan2(y, x) * (180 / 3.14159265358979324);
  return degrees < 0 ? degrees + 360 : degrees;
}

ReliefLight relief_light(const ImagePtr& color, const ImagePtr& opacity, const ImagePtr& normals, const SlowLight& slow,
                         const Task& task) {
  const std::vector<Sample> samples = samples_of(color, opacity, normals, slow);
  if (are_flat(samples)) return {};
  ReliefLight light;
  double mean = 0;
  std::vector<Equations> of_parts;
  Equations all;
  for (int i = 0; i < iterations; i++) {
    task.check();
    of_parts = equations_at(samples, light, mean);
    all = {};
    for (const Equations& part : of_parts) all += part;
    const Vector3d step = all.solved();
    mean += step[0];
    light.x += step[1];
    light.y += step[2];
    const double length = std::sqrt(light.x * light.x + light.y * light.y);
    if (length > strongest_slope) {
      light.x *= strongest_slope / length;
      light.y *= strongest_slope / length;
    }
  }
  const Fit fit = fit_of(samples, light);
  light.explained = fit.variance > 0 ? 1 - fit.left / fit.variance : 0;
  light.mean_logarithm = fit.mean_logarithm;
  const bool is_enough = light.explained >= relief_light_tuning->least_explained;
  return is_enough && certainty(of_parts, all, light) >= relief_light_tuning->least_certainty ? light : ReliefLight{};
}

ImagePtr normals_of_usual_slope(const ImagePtr& height, Outside outside) {
  double squares = 0;
  int64_t count = 0;
  const int channels = height->channels();
  for_each_strip(*height, [&](const Rect& r, const float* v) {
    for (int y = 0; y < r.height; y++)
      for (int x = 0; x < r.width; x++, v += channels) {
        const double across = x + 1 < r.width ? double(v[channels]) - double(v[0]) : 0;
        const double down = y + 1 < r.height ? double(v[int64_t{r.width} * channels]) - double(v[0]) : 0;
        squares += across * across + down * down;
        count++;
      }
  });
  const double slope = std::sqrt(squares / double(count));
  const double scale = slope > 0 ? relief_light_tuning->usual_slope / slope : 1;
  ImageInfo info = height->info();
  info.channels = 3;
  info.semantic = Semantic::normal;
  info.color_space = "raw";
  info.depth = Depth::f32;
  info.normal_y = NormalY::up;
  Operation operation{.sources = {height}, .compute = {}, .work = 10};
  operation.reads = [=, size = info.size](size_t, const Rect& region) {
    return padded_parts(size, grown(region, slope_reach), outside);
  };
  operation.compute = [=](std::span<const PixelView> in, const Rect& region, float* out) {
    normals_from_height(in[0], region, scale, SlopeFilter::scharr, outside, NormalY::up, out);
  };
  Hasher recipe;
  recipe.add("normals of usual slope").add(height->digest()).add(scale).add(int(outside));
  return Image::computed(info, recipe.digest(), std::move(operation));
}

}  // namespace terrazzo
