#include "core/analysis/repeats/border_joints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/tuning.h"
#include "core/image/image_ops.h"
#include "core/numeric/moments.h"

namespace terrazzo {

namespace {

struct BorderJointsTuning {
  int breadth = 3;
  double same_joint = 0.05;
  double unlike_most = 2.5;
  double steps_unlike_most = 5;
};
const Tunable<BorderJointsTuning> border_joints_tuning(
    "border_joints",
    {
        {&BorderJointsTuning::breadth, "breadth", "lines to each side",
         "of the joints that are compared. Higher: broad joints must be alike as a whole; lower: any step is one",
         "wrap_detection", 1, 100},
        {&BorderJointsTuning::same_joint, "same_joint", "share of the distance to all lines",
         "within which another joint is the same. Higher: parts cut out are taken to wrap; lower: worn tiles are not",
         "wrap_detection", 0, 1},
        {&BorderJointsTuning::unlike_most, "unlike_most", "mean distances of any two places",
         "that a joint has from all. Higher: joints that are close together are none; lower: lines of sand are",
         "wrap_detection", 1, 1000},
        {&BorderJointsTuning::steps_unlike_most, "steps_unlike_most", "mean changes across lines",
         "that a step across the border has. Higher: worn chequered tiles do not wrap; lower: parts of crates do",
         "wrap_detection", 1, 1000},
    });

/// The means of so many groups of pixels, by channel; of pixels that count. 0 where none does.
template <typename GroupOf>
std::vector<double> group_means(const SeenMap& map, int groups, const GroupOf& group_of) {
  const auto channels = size_t(map.image->channels()), width = size_t(map.image->width());
  std::vector<double> sums(size_t(groups) * channels, 0.0), counted(size_t(groups), 0.0);
  for_each_strip(*map.image, [&](const Rect& strip, const float* pixels) {
    for (size_t i = 0; i < size_t(strip.area()); i++) {
      const size_t x = i % width, y = size_t(strip.y) + i / width, group = group_of(x, y);
      if (!map.counts.empty() && !map.counts[y * width + x]) continue;
      counted[group]++;
      for (size_t c = 0; c < channels; c++) sums[group * channels + c] += pixels[i * channels + c];
    }
  });
  for (size_t i = 0; i < sums.size(); i++) sums[i] /= std::max(1.0, counted[i / channels]);
  return sums;
}

/// Whether a line differs more from the map's means, by channel, than along itself.
bool stands_out(const PixelLine& line, const std::vector<double>& means) {
  const size_t channels = means.size();
  const double pixels = double(std::ranges::count(line.counts, 1));
  double between = 0, within = 0;
  for (size_t c = 0; c < channels; c++) {
    double mean = 0;
    const auto each = [&](const auto& visit) {
      for (size_t i = 0; i < line.counts.size(); i++)
        if (line.counts[i]) visit(line.values[i * channels + c]);
    };
    each([&](float v) { mean += v / pixels; });
    each([&](float v) { within += (v - mean) * (v - mean) / pixels; });
    between += (mean - means[c]) * (mean - means[c]);
  }
  return between > within;
}

/// By channel, of pixels that count.
std::vector<double> means_of(const SeenMap& map) {
  return group_means(map, 1, [](size_t, size_t) { return size_t{0}; });
}

/// Whether the lines on both sides of the border stand out of a map with such means.
bool is_joint_of(const SeenMap& map, bool rows, const std::vector<double>& means) {
  return stands_out(line_of(map, rows, -1), means) && stands_out(line_of(map, rows, 0), means);
}

}  // namespace

bool has_joint_along_border(const SeenMap& map) {
  const std::vector<double> means = means_of(map);
  for (const bool rows : {true, false})
    for (const int i : {-1, 0})
      if (stands_out(line_of(map, rows, i), means)) return true;
  return false;
}

bool is_joint_that_recurs(const SeenMap& map, bool rows) {
  const auto channels = size_t(map.image->channels());
  const int lines = map.lines(rows), breadth = border_joints_tuning->breadth;
  const std::vector<double> means = group_means(map, lines, [&](size_t x, size_t y) { return rows ? y : x; });
  // Squared, of the lines around one place from those around another; places lie before the line of that number.
  const auto distance = [&](int a, int b) {
    double sum = 0;
    for (int i = -breadth; i < breadth; i++)
      for (size_t c = 0; c < channels; c++) {
        const double d =
            means[size_t(wrap(a + i, lines)) * channels + c] - means[size_t(wrap(b + i, lines)) * channels + c];
        sum += d * d;
      }
    return sum;
  };
  double nearest = std::numeric_limits<double>::max(), all = 0;
  int inside = 0;
  for (int i = 2 * breadth; i <= lines - 2 * breadth; i++, inside++) {
    const double d = distance(0, i);
    nearest = std::min(nearest, d);
    all += d;
  }
  if (inside == 0) return false;
  double any_two = 0;  // what two places differ by in the mean
  for (size_t c = 0; c < channels; c++) {
    Moments<1> of_lines;
    for (size_t i = c; i < means.size(); i += channels) of_lines.add(means[i]);
    any_two += 2 * of_lines.variance() * 2 * breadth;
  }
  return nearest < border_joints_tuning->same_joint * all / inside &&
         all / inside > border_joints_tuning->unlike_most * any_two;
}

bool is_step_that_recurs(const SeenMap& map, bool rows) {
  const int lines = map.lines(rows), breadth = border_joints_tuning->breadth;
  const auto change = [&](int at) {
    return step_between(line_of(map, rows, at - breadth), line_of(map, rows, at + breadth - 1)).distance;
  };
  const double border = change(0);
  double nearest = std::numeric_limits<double>::max(), all = 0;
  int inside = 0;
  for (int i = 2 * breadth; i <= lines - 2 * breadth; i++, inside++) {
    const double inner = change(i);
    nearest = std::min(nearest, std::abs(inner - border));
    all += inner;
  }
  return inside > 0 && nearest < border_joints_tuning->same_joint * border &&
         border > border_joints_tuning->steps_unlike_most * all / inside;
}

bool is_joint(const SeenMap& map, bool rows) {
  return is_joint_of(map, rows, means_of(map));
}

bool is_joint_by_itself(const SeenMap& map, bool rows) {
  const std::vector<double> means = means_of(map);
  const int beside = 2 * border_joints_tuning->breadth;
  return is_joint_of(map, rows, means) && !stands_out(line_of(map, rows, -1 - beside), means) &&
         !stands_out(line_of(map, rows, beside), means);
}

}  // namespace terrazzo
