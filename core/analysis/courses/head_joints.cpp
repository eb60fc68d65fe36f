#include "core/analysis/courses/head_joints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/base/geometry.h"
#include "core/base/tuning.h"
#include "core/numeric/linear_algebra.h"
#include "core/numeric/moments.h"

namespace terrazzo {

namespace {

constexpr int stagger = 7;
constexpr int column_sections = 6;  // that a course is divided into across

struct HeadJointsTuning {
  double regularised = 1e-3;
  double surely_bed = 0.6;
  double sure = 0.75;
  double unsure = 0.4;
  double outstanding_deviations = 4;
  double margin_of_joint = 1.6;
  double margin = 0.12;
  int unlike_sections = 1;
};
const Tunable<HeadJointsTuning> head_joints_tuning(
    "head_joints",
    {
        {&HeadJointsTuning::regularised, "regularised", "share of the mean variance",
         "added to each trait. Higher: traits that vary little count for less; lower: noise in them is taken for a "
         "difference",
         "What each rule decides", 0.000000001},
        {&HeadJointsTuning::surely_bed, "surely_bed", "share of half a joint",
         "around its middle, of which joints are learnt. Higher: more pixels; lower: no rims of bricks",
         "What each rule decides", 0, 1},
        {&HeadJointsTuning::sure, "sure", "likelihood of a joint, 0..1",
         "higher: faint joints are missed; lower: marks within bricks are taken for joints", "What each rule decides"},
        {&HeadJointsTuning::unsure, "unsure", "likelihood of a joint, 0..1",
         "down to which a joint goes on to its sides. Higher: two near one another are kept apart; lower: one that is "
         "worn in its middle is not taken for two",
         "What each rule decides"},
        {&HeadJointsTuning::outstanding_deviations, "outstanding_deviations", "deviations",
         "by which columns must stand out for joints to be learnt of them. Higher: only clear joints are learnt; "
         "lower: marks within bricks are, too",
         "not measured: only with and without were compared"},
        {&HeadJointsTuning::margin_of_joint, "margin_of_joint", "half breadths of a joint",
         "that a course loses to its bed joints on each side. Higher: worn bricks have no rim; lower: thin courses "
         "keep rows",
         "What each rule decides"},
        {&HeadJointsTuning::margin, "margin", "share of a course",
         "that it loses at least. Higher: bed joints may be uneven; lower: thin courses keep rows",
         "What each rule decides", 0, 0.5},
        {&HeadJointsTuning::unlike_sections, "unlike_sections", "sections of six",
         "of a course across, which need not look like the joint. Higher: broken joints are found; lower: marks that "
         "do not reach across are not",
         "not measured: all but one of six", 0, 5},
    });

constexpr int most_samples = 1 << 17;  // pixels that joints and bricks are learnt from; bounds the time

/// What a pixel is judged by: itself, what is around it, and how much that varies.
constexpr int most_traits = 2 * CourseSheet::most_channels + 1;
using Traits = std::array<double, most_traits>;

int trait_count(const CourseSheet& sheet) {
  return 2 * sheet.channels() + 1;
}

Traits traits_of(const CourseSheet& sheet, int along, int across, int radius) {
  const auto channels = size_t(sheet.channels());
  Traits out{};
  double squares = 0;
  int n = 0;
  for (int v = across - radius; v <= across + radius; v++)
    for (int u = along - radius; u <= along + radius; u++) {
      if (!sheet.has(v) || (!sheet.wraps && (u < 0 || u >= sheet.length))) continue;
      n++;
      for (size_t c = 0; c < channels; c++) {
        const double value = sheet.at(u, v)[c];
        out[channels + c] += value;
        squares += value * value;
      }
    }
  double of_means = 0;
  for (size_t c = 0; c < channels; c++) {
    out[c] = sheet.at(along, across)[c];
    out[channels + c] /= n;
    of_means += out[channels + c] * out[channels + c];
  }
  out[2 * channels] = std::sqrt(std::max(0.0, squares / n - of_means));
  return out;
}

double percentile(std::vector<double> values, double share) {
  const auto at = values.begin() + std::ptrdiff_t(share * double(values.size()));
  std::ranges::nth_element(values, at);
  return *at;
}

/// By how much values lie below 0, where what is far above has no say.
double deviation_of_lesser(const std::vector<std::vector<double>>& values) {
  constexpr double tenth_percentile = 1.2816;  // of the normal distribution, in deviations
  std::vector<double> all;
  for (const std::vector<double>& some : values) all.insert(all.end(), some.begin(), some.end());
  return -percentile(std::move(all), 0.1) / tenth_percentile;
}

/// Where there is at least so much, and most of all that is nearer than `apart`.
std::vector<int> joint_peaks(const std::vector<double>& values, double least, int apart) {
  std::vector<int> candidates, out;
  for (int u = 0; u < int(values.size()); u++)
    if (values[size_t(u)] > least) candidates.push_back(u);
  std::ranges::stable_sort(candidates, std::greater{}, [&](int u) { return values[size_t(u)]; });
  for (const int u : candidates)
    if (std::ranges::none_of(out, [&](int other) { return std::abs(u - other) < apart; })) out.push_back(u);
  return out;
}

int radius_of(int half_breadth) {
  return std::max(1, half_breadth);
}

}  // namespace

CourseInside::CourseInside(const ExemplarCourse& course, int half_breadth) {
  const double margin = std::max(head_joints_tuning->margin_of_joint * half_breadth + 1,
                                 head_joints_tuning->margin * (course.end - course.begin));
  begin = int(std::floor(course.begin + margin));
  end = int(std::floor(course.end - margin));
}

/// What joints and bricks look like, by some of their pixels.
class HeadJoints::Samples {
 public:
  Samples(const CourseSheet& sheet, int half_breadth)
      : joints(trait_count(sheet)),
        bricks(trait_count(sheet)),
        sheet_(sheet),
        radius_(radius_of(half_breadth)),
        surely_(int(head_joints_tuning->surely_bed * half_breadth + 0.5)),
        surely_not_(2 * half_breadth + 2),
        step_(std::max(1, int(int64_t{sheet.length} * sheet.breadth / most_samples))) {}

  /// Those of these rows that a pattern has which shows every column.
  void add_rows(int begin, int end, Moments<>& to) {
    for (int v = begin; v < end; v++)
      for (int u = first_of(v); sheet_.has(v) && u < sheet_.length; u += step_) add(u, v, to);
  }

  /// All of the joints, of which there are few, and of the others those that the pattern has.
  void add_columns(const CourseInside& rows, const std::vector<int>& middles) {
    std::vector<int> from_joint(size_t(sheet_.length), sheet_.length);
    for (int u = 0; u < sheet_.length; u++)
      for (const int middle : middles) from_joint[size_t(u)] = std::min(from_joint[size_t(u)], std::abs(u - middle));
    for (int v = rows.begin; v < rows.end; v++) {
      for (int u = 0; u < sheet_.length; u++)
        if (from_joint[size_t(u)] <= surely_) add(u, v, joints);
      for (int u = first_of(v); u < sheet_.length; u += step_)
        if (from_joint[size_t(u)] > surely_not_) add(u, v, bricks);
    }
  }

  Moments<> joints, bricks;

 private:
  int first_of(int across) const { return wrap(across * stagger, step_); }
  void add(int along, int across, Moments<>& to) {
    if (sheet_.usable(along, across)) to.add(traits_of(sheet_, along, across, radius_).data());
  }

  const CourseSheet& sheet_;
  int radius_, surely_, surely_not_;  // from the middle of a joint
  int step_;
};

HeadJoints::HeadJoints(const CourseSheet& sheet, const std::vector<ExemplarCourse>& courses, int half_breadth)
    : sheet_(sheet), half_breadth_(half_breadth) {
  const double surely = head_joints_tuning->surely_bed;
  Samples samples(sheet, half_breadth);
  for (const ExemplarCourse& c : courses) {
    for (const double bed : {c.begin, c.end}) {
      const int first = int(std::floor(bed - surely * half_breadth + 0.5));
      const int last = int(std::floor(bed + surely * half_breadth + 0.5));
      if (sheet.has(first) && sheet.has(last)) samples.add_rows(first, last + 1, samples.joints);
    }
    const CourseInside inside(c, half_breadth);
    samples.add_rows(inside.begin, inside.end, samples.bricks);
  }
  separate(samples);
}

void HeadJoints::separate(const Samples& samples) {
  const Moments<>& joints = samples.joints;
  const Moments<>& bricks = samples.bricks;
  if (joints.count() == 0 || bricks.count() == 0) return;
  const VectorXd apart = joints.mean_vector() - bricks.mean_vector();
  MatrixXd spread = joints.covariance_matrix() + bricks.covariance_matrix();
  const double variance = spread.trace() / double(apart.size());
  if (!(variance > 0)) return;
  spread.diagonal().array() += head_joints_tuning->regularised * variance;
  weights_ = solve_positive_definite(spread, apart);
  const double squared = weights_.dot(apart);
  if (!(squared > 0)) return;
  // The mean joint is 1, the mean brick 0.
  weights_ /= squared;
  offset_ = -weights_.dot(bricks.mean_vector());
  separability_ = std::sqrt(squared);
}

std::vector<double> HeadJoints::likeness(const ExemplarCourse& course) const {
  const CourseInside inside(course, half_breadth_);
  const int height = inside.end - inside.begin;
  using Sections = std::array<double, column_sections>;
  std::vector<Sections> columns(size_t(sheet_.length));
  const auto of = [&](int u, int v) {
    const Traits f = traits_of(sheet_, u, v, radius_of(half_breadth_));
    double sum = offset_;
    for (int i = 0; i < weights_.size(); i++) sum += weights_[i] * f[size_t(i)];
    return sum;
  };
  for (int u = 0; u < sheet_.length; u++)
    for (int s = 0; s < column_sections; s++) {
      const int first = inside.begin + s * height / column_sections;
      const int end = std::max(first + 1, inside.begin + (s + 1) * height / column_sections);
      for (int v = first; v < end; v++) columns[size_t(u)][size_t(s)] += of(u, v) / (end - first);
    }
  std::vector<double> out(size_t(sheet_.length), 0.0);
  const int reach = half_breadth_ / 2, unlike_sections = head_joints_tuning->unlike_sections;
  for (int u = 0; u < sheet_.length; u++) {
    const int begin = sheet_.wraps ? u - reach : std::max(0, u - reach);
    const int end = sheet_.wraps ? u + reach + 1 : std::min(sheet_.length, u + reach + 1);
    Sections mean{};
    for (int k = begin; k < end; k++)
      for (size_t s = 0; s < column_sections; s++)
        mean[s] += columns[size_t(wrap(k, sheet_.length))][s] / (end - begin);
    std::ranges::nth_element(mean, mean.begin() + unlike_sections);
    out[size_t(u)] = mean[size_t(unlike_sections)];
  }
  return out;
}

bool HeadJoints::learn_from(const std::vector<ExemplarCourse>& courses, std::vector<std::vector<double>> likeness) {
  for (std::vector<double>& columns : likeness) {
    const double usual = percentile(columns, 0.5);
    for (double& column : columns) column -= usual;
  }
  const double least = head_joints_tuning->outstanding_deviations * deviation_of_lesser(likeness);
  std::vector<std::vector<int>> joints;
  bool found = false;
  for (const std::vector<double>& columns : likeness) {
    joints.push_back(joint_peaks(columns, least, 2 * half_breadth_ + 2));
    found |= !joints.back().empty();
  }
  if (!found) return false;

  Samples samples(sheet_, half_breadth_);
  for (size_t i = 0; i < courses.size(); i++) samples.add_columns(CourseInside(courses[i], half_breadth_), joints[i]);
  separate(samples);
  return true;
}

std::vector<double> sure_joints(const ExemplarCourse& course) {
  std::vector<double> out;
  const size_t length = course.joint.size();
  const auto sure = float(head_joints_tuning->sure), unsure = float(head_joints_tuning->unsure);
  for (size_t u = 0; u < length; u++) {
    const size_t begin = u;
    float most = 0;
    for (; u < length && course.joint[u] >= unsure; u++) most = std::max(most, course.joint[u]);
    if (most >= sure) out.push_back(double(begin + u) / 2);
  }
  return out;
}

}  // namespace terrazzo
