#include "core/synthesis/state/control.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <tbb/parallel_for.h>

#include "core/base/hash.h"
#include "core/base/tuning.h"
#include "core/filter/resample.h"
#include "core/image/distribution.h"
#include "core/image/image_facts.h"
#include "core/synthesis/state/labels.h"

namespace terrazzo {

namespace {

struct ControlTuning {
  double values_factor = 8;
  double feature_side = 1.0 / 16;
  double extreme_ranks = 0.05;
  int gray_bin_bits = 4;
};
const Tunable<ControlTuning> control_tuning(
    "control",
    {
        {&ControlTuning::values_factor, "values_factor", "cost of a wrong label",
         "higher: the largest difference of values costs more, and the picture shows more clearly; lower: features "
         "stay whole",
         "What each rule decides"},
        {&ControlTuning::feature_side, "feature_side", "exemplar sides",
         "higher: values may differ as they do in larger features, which stay whole; lower: the picture shows more "
         "clearly",
         "control", 0, 1},
        {&ControlTuning::extreme_ranks, "extreme_ranks", "share of the exemplar's pixels",
         "higher: more of the darkest and of the lightest values count as one, so that enough pixels show them; lower: "
         "the picture keeps its contrast",
         "control", 0, 0.5},
        {&ControlTuning::gray_bin_bits, "gray_bin_bits", "bits",
         "higher: demand is counted by finer grey values; lower: bins hold enough pixels to serve it. A channel of "
         "colours has half as many",
         "What each rule decides", 2, 8},
    });

// Smaller ranges of values are taken for this one, so that noise does not become a picture.
constexpr double least_range = 1.0 / 255;
constexpr double most_weight = 1e9;  // keeps sums of weighted squares within 64 bits
constexpr int deviation_windows = 512,
              distance_pairs = 1024;  // sample sizes: the means they give vary by a few per cent

/// Puts bytes made from each pixel's values into channels [first, first + count) of the planes.
template <typename Encode>
void put(const Image& image, ControlPlanes& planes, int first, const Encode& encode) {
  const float* values = image.in_memory();
  tbb::parallel_for(0, planes.size.height, [&](int y) {
    for (int x = 0; x < planes.size.width; x++) {
      const int64_t i = int64_t{y} * planes.size.width + x;
      encode(values + i * image.channels(), &planes.values[size_t(i) * planes.channels + first]);
    }
  });
}

/// How a channel's values become bytes.
struct ByteScale {
  double low, high;    ///< become 0 and 255
  double least, most;  ///< values are clamped to them first
  uint8_t operator()(double v) const {
    return uint8_t(std::floor(255 * std::clamp((std::clamp(v, least, most) - low) / (high - low), 0.0, 1.0) + 0.5));
  }
};

void put_values(const Control& control, ControlPlanes& exemplar, ControlPlanes& target, int first, const Task& task) {
  const ImagePtr has = numbers_at_size(control.exemplar, exemplar.size, task);
  const ImagePtr wants = numbers_at_size(control.target, target.size, task);
  const std::vector<Distribution> own = Distribution::of(*has, task), wanted = Distribution::of(*wants, task);
  std::vector<ByteScale> scales;
  std::vector<PiecewiseLinear> curves;
  for (size_t c = 0; c < own.size(); c++) {
    double low = own[c].min(), high = own[c].max();
    if (control.match == Control::Match::none) {
      low = std::min<double>(low, wanted[c].min());
      high = std::max<double>(high, wanted[c].max());
    }
    const bool by_rank = control.match == Control::Match::histogram;
    scales.push_back({low, std::max(high, low + least_range),
                      by_rank ? own[c].quantile(control_tuning->extreme_ranks) : low,
                      by_rank ? own[c].quantile(1 - control_tuning->extreme_ranks) : high});
    if (by_rank)
      curves.push_back(matching_curve(wanted[c], own[c]));
    else if (control.match == Control::Match::range)
      curves.push_back(PiecewiseLinear(
          {wanted[c].min(), std::max<double>(wanted[c].max(), wanted[c].min() + least_range)}, {low, high}));
  }
  put(*has, exemplar, first, [&](const float* in, uint8_t* out) {
    for (size_t c = 0; c < scales.size(); c++) out[c] = scales[c](in[c]);
  });
  put(*wants, target, first, [&](const float* in, uint8_t* out) {
    for (size_t c = 0; c < scales.size(); c++) out[c] = scales[c](curves.empty() ? in[c] : curves[c](in[c]));
  });
}

void put_labels(const std::vector<uint8_t>& bytes, const ControlPyramid::Part& part, ControlPlanes& planes) {
  for (size_t i = 0; i < size_t(planes.size.area()); i++)
    std::copy_n(&bytes[i * size_t(part.count)], part.count, &planes.values[i * size_t(planes.channels) + part.first]);
}

ControlPlanes empty(Size size, int channels) {
  return {size, channels, std::vector<uint8_t>(size_t(size.area()) * channels)};
}

/// Each pixel is the rounded mean of the up to four finer ones that it covers.
ControlPlanes halved(const ControlPlanes& in) {
  ControlPlanes out = empty({(in.size.width + 1) / 2, (in.size.height + 1) / 2}, in.channels);
  tbb::parallel_for(0, out.size.height, [&](int y) {
    const int below[2] = {2 * y, std::min(2 * y + 1, in.size.height - 1)};
    for (int x = 0; x < out.size.width; x++) {
      const int beside[2] = {2 * x, std::min(2 * x + 1, in.size.width - 1)};
      for (int c = 0; c < in.channels; c++) {
        int sum = 2;
        for (const int v : below)
          for (const int u : beside) sum += in.at(int64_t{v} * in.size.width + u)[c];
        out.values[(size_t(y) * out.size.width + x) * out.channels + c] = uint8_t(sum / 4);
      }
    }
  });
  return out;
}

/// How much the channels [first, end) vary within a feature: their mean deviation in windows of its size.
double deviation_within_features(const ControlPlanes& planes, int first, int end) {
  const Size size = planes.size;
  const int reach = std::max(1, int(std::max(size.width, size.height) * control_tuning->feature_side / 2));
  double total = 0;
  for (int i = 0; i < deviation_windows; i++) {
    const int x = int(below(uint32_t(random_bits(33, i)), uint32_t(size.width)));
    const int y = int(below(uint32_t(random_bits(34, i)), uint32_t(size.height)));
    const int left = std::max(0, x - reach), right = std::min(size.width - 1, x + reach);
    const int top = std::max(0, y - reach), bottom = std::min(size.height - 1, y + reach);
    const double count = double(right - left + 1) * (bottom - top + 1);
    for (int c = first; c < end; c++) {
      double sum = 0, squares = 0;
      for (int v = top; v <= bottom; v++)
        for (int u = left; u <= right; u++) {
          const double value = planes.at(int64_t{v} * size.width + u)[c];
          sum += value;
          squares += value * value;
        }
      total += std::sqrt(std::max(0.0, squares / count - (sum / count) * (sum / count)));
    }
  }
  return total / deviation_windows / (end - first);
}

/// The mean squared distance of random pairs of appearance vectors.
double typical_distance(const PaddedLevel& level) {
  int64_t sum = 0;
  for (int i = 0; i < distance_pairs; i++) {
    const auto [x, y] = level.place(random_bits(31, i));
    const auto [u, v] = level.place(random_bits(32, i));
    sum += squared_distance(*level.at(x, y), *level.at(u, v));
  }
  return double(sum) / distance_pairs;
}

}  // namespace

ControlPyramid::ControlPyramid(const std::vector<Control>& controls, Size exemplar, Size finest, Size output,
                               int levels, const Task& task) {
  if (controls.empty()) return;
  int channels = 0;
  std::vector<PaintedLabels> labels;
  for (const Control& control : controls) {
    require_control(control.mode, facts_of(control.exemplar->info()), facts_of(control.target->info()), exemplar);
    const bool is_labels = control.mode == Control::Mode::labels;
    labels.push_back(is_labels ? painted_labels(control, finest, output, task) : PaintedLabels{});
    const int count = is_labels ? labels.back().count : control.exemplar->channels();
    parts_.push_back({channels, count, control.strength, is_labels});
    channels += count;
  }
  exemplar_.push_back(terrazzo::empty(finest, channels));
  target_.push_back(terrazzo::empty(output, channels));
  for (size_t i = 0; i < controls.size(); i++) {
    task.check();
    if (parts_[i].labels) {
      put_labels(wanted_labels(labels[i].exemplar, labels[i].count, finest, 0, task), parts_[i], exemplar_[0]);
      put_labels(wanted_labels(labels[i].target, labels[i].count, output, controls[i].leeway, task), parts_[i],
                 target_[0]);
    } else {
      put_values(controls[i], exemplar_[0], target_[0], parts_[i].first, task);
    }
  }
  for (int l = 1; l < levels; l++) {
    exemplar_.push_back(halved(exemplar_.back()));
    target_.push_back(halved(target_.back()));
  }
}

LevelControl::LevelControl(const ControlPyramid& pyramid, int level, const PaddedLevel& exemplar)
    : exemplar_(pyramid.exemplar(level)), target_(pyramid.target(level)) {
  const double typical = typical_distance(exemplar);
  for (const ControlPyramid::Part& part : pyramid.parts()) {
    // Two labels differ in two channels.
    const double whole = 255.0 * 255 * (part.labels ? 2 : part.count);
    const double factor = part.strength * typical * (part.labels ? 1 : control_tuning->values_factor) / whole;
    const double weight = std::min(factor * (1 << weight_bits), most_weight);
    const int end = part.first + part.count;
    // Without slack the few places that have the wanted value all around them would be shown over and over.
    const double slack =
        part.labels ? 0
                    : deviation_within_features(exemplar_, part.first, end) / std::sqrt(std::max(1.0, part.strength));
    parts_.push_back({part.first, end, uint64_t(std::floor(weight + 0.5)), part.labels, int(slack),
                      control_tuning->gray_bin_bits / (part.count == 1 ? 1 : 2)});
    influence_ = std::max(influence_, std::min(1.0, part.strength));
  }
}

uint64_t LevelControl::key(const uint8_t* values) const {
  uint64_t key = 0;
  for (const Part& part : parts_) {
    if (part.labels)  // The label that covers most: if mixtures had bins of their own, few pixels would serve all
                      // borders.
      key = random_bits(key, uint64_t(std::max_element(values + part.first, values + part.end) - values));
    else
      for (int c = part.first; c < part.end; c++) key = random_bits(key, values[c] >> (8 - part.bin_bits));
  }
  return key;
}

std::vector<double> LevelControl::demand(const std::vector<uint8_t>& usable) const {
  struct Counts {
    int64_t has = 0, wants = 0;
  };
  std::map<uint64_t, Counts> bins;
  std::vector<double> demand(size_t(exemplar_.size.area()));
  const auto is_usable = [&](size_t i) { return usable.empty() || usable[i]; };
  int64_t has = 0, wants = 0;
  for (size_t i = 0; i < demand.size(); i++)
    if (is_usable(i)) bins[key(exemplar_.at(int64_t(i)))].has++, has++;
  for (int64_t i = 0; i < target_.size.area(); i++) {
    const auto bin = bins.find(key(target_.at(i)));
    if (bin != bins.end()) bin->second.wants++, wants++;
  }
  for (size_t i = 0; i < demand.size(); i++) {
    if (!is_usable(i)) continue;
    const Counts& bin = bins.at(key(exemplar_.at(int64_t(i))));
    const double ratio = wants > 0 ? double(bin.wants) / double(wants) * double(has) / double(bin.has) : 1.0;
    demand[i] = 1 + influence_ * (ratio - 1);
  }
  return demand;
}

}  // namespace terrazzo
