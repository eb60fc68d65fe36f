#include "core/synthesis/state/labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "core/base/error.h"
#include "core/base/tuning.h"
#include "core/image/image_facts.h"
#include "core/image/image_ops.h"
#include "core/numeric/distance_transform.h"

namespace terrazzo {

namespace {

struct LabelsTuning {
  double around_core = 1.5;
};
const Tunable<LabelsTuning> labels_tuning(
    "labels", {{&LabelsTuning::around_core, "around_core", "leeways",
                "how far from a disc of the leeway's radius that fits into an area the area still has leeway. Higher: "
                "sharper corners may become round; lower: borders keep to their line near corners",
                "What each rule decides", 0, 1000}});

/// A value in 255ths; grey as a colour.
using Label = std::array<int, 4>;

Label label_of(const float* values, int channels) {
  Label label{};
  for (int c = 0; c < std::max(3, channels); c++) {
    const double v = double(values[channels == 1 ? 0 : std::min(c, channels - 1)]);
    label[size_t(c)] = int(std::floor(std::clamp(v, -1e6, 1e6) * 255 + 0.5));
  }
  return label;
}

/// Sorted.
std::vector<Label> labels_in(const Image& image) {
  std::set<Label> found;
  const float* values = image.in_memory();
  for (int64_t i = 0; i < image.size().area(); i++) {
    found.insert(label_of(values + i * image.channels(), image.channels()));
    if (found.size() > most_labels)
      throw Error("exemplar_control",
                  fmt::format("expected at most {} different labels, found more: this looks like values rather than "
                              "labels; use mode \"values\", or flatten it with \"threshold\" or \"cluster\"",
                              most_labels));
  }
  return {found.begin(), found.end()};
}

size_t nearest_label(const std::vector<Label>& labels, const Label& to) {
  size_t best = 0;
  int64_t least = std::numeric_limits<int64_t>::max();
  for (size_t i = 0; i < labels.size(); i++) {
    int64_t sum = 0;
    for (size_t c = 0; c < to.size(); c++) sum += int64_t{labels[i][c] - to[c]} * (labels[i][c] - to[c]);
    if (sum >= least) continue;
    least = sum;
    best = i;
  }
  return best;
}

std::vector<uint8_t> numbered(const Image& image, const std::vector<Label>& labels) {
  std::vector<uint8_t> out(size_t(image.size().area()));
  const float* values = image.in_memory();
  const int n = image.channels();
  tbb::parallel_for(0, image.height(), [&](int y) {
    for (size_t i = size_t(y) * image.width(); i < size_t(y + 1) * image.width(); i++)
      out[i] = uint8_t(nearest_label(labels, label_of(values + i * size_t(n), n)));
  });
  return out;
}

double unknown_part(const Image& image, const std::vector<Label>& known) {
  const float* values = image.in_memory();
  int64_t unknown = 0;
  for (int64_t i = 0; i < image.size().area(); i++)
    unknown += !std::ranges::binary_search(known, label_of(values + i * image.channels(), image.channels()));
  return double(unknown) / double(image.size().area());
}

/// Where a label's border may move: up to `leeway` from pixels of others, but not in parts so thin, or tips so sharp,
/// that no disc of that radius fits.
std::vector<uint8_t> movable_border(const std::vector<uint8_t>& is_label, Size size, double leeway) {
  const auto beyond = int64_t(leeway * leeway),
             around = int64_t(labels_tuning->around_core * labels_tuning->around_core * leeway * leeway);
  const auto all_where = [&](const auto& test) {
    std::vector<uint8_t> out(is_label.size());
    for (size_t i = 0; i < out.size(); i++) out[i] = test(i);
    return out;
  };
  const std::vector<int64_t> to_others =
      squared_distances(all_where([&](size_t i) { return !is_label[i]; }), size, false);
  const std::vector<uint8_t> core = all_where([&](size_t i) { return is_label[i] && to_others[i] > beyond; });
  const std::vector<int64_t> to_core = squared_distances(core, size, false);
  return all_where([&](size_t i) { return is_label[i] && !core[i] && to_core[i] <= around; });
}

}  // namespace

PaintedLabels painted_labels(const Control& control, Size exemplar, Size output, const Task& task) {
  require_control(control.mode, facts_of(control.exemplar->info()), facts_of(control.target->info()), std::nullopt);
  const ImagePtr has = materialized(nearest_at_size(control.exemplar, exemplar), task);
  const std::vector<Label> labels = labels_in(*has);
  const ImagePtr wants = materialized(nearest_at_size(control.target, output), task);
  PaintedLabels out{int(labels.size()), numbered(*has, labels), numbered(*wants, labels), unknown_part(*wants, labels)};
  std::array<bool, most_labels> shown{};
  for (const uint8_t label : out.target) shown[label] = true;
  out.wanted = int(std::ranges::count(shown, true));
  return out;
}

std::vector<uint8_t> wanted_labels(const std::vector<uint8_t>& target, int count, Size size, double leeway,
                                   const Task& task) {
  constexpr uint8_t whole = 255, near = 1;
  std::vector<uint8_t> out(target.size() * size_t(count), 0);
  for (size_t i = 0; i < target.size(); i++) out[i * size_t(count) + target[i]] = whole;
  if (leeway <= 0 || count < 2) return out;
  const auto squared = int64_t(leeway * leeway);
  std::vector<uint8_t> free(target.size(), 0), is_label(target.size());
  const auto for_each_shown = [&](const auto& visit) {
    for (int label = 0; label < count; label++) {
      task.check();
      bool any = false;
      for (size_t i = 0; i < target.size(); i++) any |= is_label[i] = target[i] == label;
      if (any) visit(size_t(label));
    }
  };
  for_each_shown([&](size_t) {
    const std::vector<uint8_t> movable = movable_border(is_label, size, leeway);
    for (size_t i = 0; i < free.size(); i++) free[i] |= movable[i];
  });
  for_each_shown([&](size_t label) {
    const std::vector<int64_t> distances = squared_distances(is_label, size, false);
    for (size_t i = 0; i < free.size(); i++)
      if (free[i] && distances[i] <= squared) out[i * size_t(count) + label] = near;
  });
  for (size_t i = 0; i < free.size(); i++) {
    if (!free[i]) continue;
    uint8_t* labels = &out[i * size_t(count)];
    const auto shared = uint8_t(whole / std::max<int64_t>(1, std::count(labels, labels + count, near)));
    std::replace(labels, labels + count, near, shared);
  }
  return out;
}

}  // namespace terrazzo
