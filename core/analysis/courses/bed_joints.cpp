#include "core/analysis/courses/bed_joints.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <tbb/parallel_for.h>

#include "core/base/geometry.h"
#include "core/base/tuning.h"

namespace terrazzo {

namespace {

constexpr int sections = 16;  // that a line is divided into

struct BedJointsTuning {
  double clearly_thicker = 1.1;
  double other_joint = 0.6;
  double least_course = 0.2;
  int thicknesses = 4;
  int unlike_sections = 4;
};
const Tunable<BedJointsTuning> bed_joints_tuning(
    "bed_joints",
    {
        {&BedJointsTuning::clearly_thicker, "clearly_thicker", "factor",
         "by which a thicker joint must be clearer. Higher: thin joints; lower: rims of bricks belong to them",
         "What each rule decides"},
        {&BedJointsTuning::other_joint, "other_joint", "share of the clearest joint",
         "what another of the period must have. Higher: courses of two heights are taken for one; lower: marks along "
         "courses are taken for joints",
         "What each rule decides", 0.05},
        {&BedJointsTuning::least_course, "least_course", "share of a period",
         "higher: low courses are overlooked; lower: the rims of one joint are taken for two", "What each rule decides",
         0, 0.5},
        {&BedJointsTuning::thicknesses, "thicknesses", "thicknesses",
         "that are tried, from that of a pixel on. Higher: thick joints are found; costs time",
         "What each rule decides", 1, 100},
        {&BedJointsTuning::unlike_sections, "unlike_sections", "sections of sixteen",
         "of a line, which need not show the joint. Higher: broken joints are found; lower: marks that do not reach "
         "across are not",
         "not measured: three in four must", 0, 15},
    });

using Values = std::array<double, CourseSheet::most_channels>;
/// The mean of each section.
using Line = std::array<Values, sections>;

std::vector<Line> line_means(const CourseSheet& sheet) {
  std::vector<Line> out(size_t(sheet.breadth));
  tbb::parallel_for(0, sheet.breadth, [&](int v) {
    for (int s = 0; s < sections; s++) {
      Values& mean = out[size_t(v)][size_t(s)];
      const int begin = s * sheet.length / sections, end = (s + 1) * sheet.length / sections;
      for (int u = begin; u < end; u++)
        for (int c = 0; c < sheet.channels(); c++) mean[size_t(c)] += sheet.at(u, v)[c] / (end - begin);
    }
  });
  return out;
}

double dot(const Values& a, const Values& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); i++) sum += a[i] * b[i];
  return sum;
}

/// How far a strip lies apart from its two sides, in each section in the way in which it does on the whole: what all
/// but the unlike sections have.
double ridge(const std::vector<Line>& lines, int middle, int half_breadth) {
  const auto mean = [&](int at, size_t s, size_t c) {
    double sum = 0;
    for (int k = -half_breadth; k <= half_breadth; k++) sum += lines[size_t(at + k)][s][c];
    return sum / (2 * half_breadth + 1);
  };
  const int away = 2 * half_breadth + 2;
  Line apart{};
  Values total{};
  for (size_t s = 0; s < sections; s++)
    for (size_t c = 0; c < total.size(); c++) {
      apart[s][c] = mean(middle, s, c) - (mean(middle - away, s, c) + mean(middle + away, s, c)) / 2;
      total[c] += apart[s][c];
    }
  const double length = std::sqrt(dot(total, total));
  if (length == 0) return 0;
  std::array<double, sections> along{};
  for (size_t s = 0; s < sections; s++) along[s] = dot(apart[s], total) / length;
  const auto nth = along.begin() + bed_joints_tuning->unlike_sections;
  std::nth_element(along.begin(), nth, along.end());
  return *nth;
}

/// The ridges by their place in the period: a bin per pixel.
std::vector<double> folded_ridges(const std::vector<Line>& lines, double period, int half_breadth) {
  const int bins = int(period + 0.5), margin = 3 * half_breadth + 2;
  std::vector<double> sum(size_t(bins), 0.0), count(size_t(bins), 0.0);
  for (int v = margin; v < int(lines.size()) - margin; v++) {
    const double place = v / period;
    const auto bin = std::min(size_t(bins) - 1, size_t((place - std::floor(place)) * bins));
    sum[bin] += ridge(lines, v, half_breadth);
    count[bin]++;
  }
  for (size_t i = 0; i < sum.size(); i++) sum[i] /= std::max(1.0, count[i]);
  return sum;
}

/// The clearest ridges that lie a course apart.
std::vector<double> peaks(const std::vector<double>& ridges, double period, int half_breadth) {
  const int bins = int(ridges.size()), apart = std::max(6 * half_breadth, int(bed_joints_tuning->least_course * bins));
  std::vector<double> places, left = ridges;
  const double clearest = *std::ranges::max_element(ridges);
  for (;;) {
    const int top = int(std::ranges::max_element(left) - left.begin());
    if (left[size_t(top)] < bed_joints_tuning->other_joint * clearest) break;
    double weights = 0, moment = 0;
    for (int k = -half_breadth - 1; k <= half_breadth + 1; k++) {
      const double w = std::max(0.0, ridges[size_t(wrap(top + k, bins))]);
      weights += w;
      moment += w * k;
    }
    const double place = (top + 0.5 + moment / weights) / bins;
    places.push_back((place - std::floor(place)) * period);
    for (int k = -apart; k <= apart; k++) left[size_t(wrap(top + k, bins))] = -1;
  }
  std::ranges::sort(places);
  return places;
}

}  // namespace

BedJoints find_bed_joints(const CourseSheet& sheet, double period) {
  const std::vector<Line> lines = line_means(sheet);
  BedJoints out;
  double clearest = 0;
  for (int half_breadth = 0; half_breadth < bed_joints_tuning->thicknesses; half_breadth++) {
    const std::vector<double> ridges = folded_ridges(lines, period, half_breadth);
    const double clear = *std::ranges::max_element(ridges);
    if (clear <= bed_joints_tuning->clearly_thicker * clearest) continue;
    clearest = clear;
    out = {half_breadth, peaks(ridges, period, half_breadth)};
  }
  return out;
}

}  // namespace terrazzo
