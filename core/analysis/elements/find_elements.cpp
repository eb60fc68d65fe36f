#include "core/analysis/elements/find_elements.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/analysis/elements/line_responses.h"
#include "core/analysis/elements/partition.h"
#include "core/analysis/space/planes.h"
#include "core/base/tuning.h"
#include "core/numeric/distance_transform.h"
#include "core/numeric/linear_algebra.h"

namespace terrazzo {

namespace {

struct FindElementsTuning {
  int most_side = 256;
  int scales = 3;
  int components = 3;
  int clues = 4;
  int rounds = 2;
  double unsure = 2.5;
  double sure = 7;
};
const Tunable<FindElementsTuning> find_elements_tuning(
    "find_elements",
    {
        {&FindElementsTuning::most_side, "most_side", "pixels",
         "the longest side that is looked at. Higher: narrow joints of large exemplars are found; costs time",
         "elements", 32, 4096},
        {&FindElementsTuning::scales, "scales", "scales",
         "widths of joints that are tried, each twice the one before. Costs time", "elements", 1, 6},
        {&FindElementsTuning::components, "components", "components",
         "principal components that are looked at. Costs time", "elements", 1, 16},
        {&FindElementsTuning::clues, "clues", "signed components",
         "that are tried at the finest scale, those best at coarser ones. Costs time", "elements", 1, 64},
        {&FindElementsTuning::rounds, "rounds", "rounds", "of learning what joints look like. Costs time", "elements",
         0, 8},
        {&FindElementsTuning::unsure, "unsure", "confidence", "that noise, grass and sand come to", "elements"},
        {&FindElementsTuning::sure, "sure", "confidence", "from which on it is certain", "elements", 0.1},
    });

constexpr double line_width = 1;  // of line_responses, in pixels of its scale

/// From 0 for the lowest twentieth to 255 for the highest hundredth.
std::vector<uint8_t> as_relief(const std::vector<float>& values) {
  std::vector<float> sorted = values;
  const auto quantile = [&](double q) {
    const auto at = sorted.begin() + std::ptrdiff_t(q * double(sorted.size() - 1));
    std::nth_element(sorted.begin(), at, sorted.end());
    return *at;
  };
  const float low = quantile(0.05), high = quantile(0.99);
  const float unit = 255 / std::max(1e-9f, high - low);
  std::vector<uint8_t> out(values.size());
  for (size_t i = 0; i < out.size(); i++) out[i] = uint8_t(std::clamp((values[i] - low) * unit, 0.0f, 255.0f));
  return out;
}

/// What joints look like at a scale, and the picture parted along them.
struct BestPartition {
  Partition partition;
  std::vector<uint8_t> relief;
  Size size;
  size_t scale = 0;
  double quality = 0;
};

/// Takes over what is better than the best so far. Returns the quality.
double consider(const std::vector<float>& lines, const Planes& at, size_t scale, BestPartition& best) {
  std::vector<uint8_t> relief = as_relief(lines);
  Partition p = partitioned(relief, at.size, at.wraps, line_width);
  const double quality = p.quality();
  if (quality > best.quality) best = {std::move(p), std::move(relief), at.size, scale, quality};
  return quality;
}

std::vector<float> along(const Planes& responses, const VectorXd& direction) {
  std::vector<float> out(size_t(responses.size.area()));
  for (size_t i = 0; i < out.size(); i++) {
    double sum = 0;
    for (int c = 0; c < responses.channels; c++)
      sum += direction[c] * double(responses.values[i * size_t(responses.channels) + size_t(c)]);
    out[i] = float(sum);
  }
  return out;
}

/// The mix of channels that best tells the joints found so far from what is far from them (Fisher's discriminant).
/// Empty if there is too little of either.
VectorXd telling_direction(const Planes& responses, const Partition& p) {
  const std::vector<int64_t> distance =
      squared_distances(border_pixels(p.regions.at, responses.size, responses.wraps), responses.size, responses.wraps);
  Moments<> joints(responses.channels), inside(responses.channels);
  for (size_t i = 0; i < distance.size(); i++) {
    const float* v = &responses.values[i * size_t(responses.channels)];
    if (distance[i] == 0) joints.add(v);
    if (distance[i] > 9) inside.add(v);
  }
  constexpr int64_t least = 50;
  if (joints.count() < least || inside.count() < least) return {};
  MatrixXd within = joints.covariance_matrix() + inside.covariance_matrix();
  within.diagonal().array() += 0.01 * within.trace() / responses.channels + 1e-9;
  return solve_positive_definite(within, joints.mean_vector() - inside.mean_vector());
}

/// Something that may be high where joints are: a channel of line_responses, upright or upside down.
struct Clue {
  int channel;
  double sign;
  double quality = 0;  ///< the best at the scales tried so far
};

/// Joints are not where there are no edges, the last channel.
std::vector<Clue> clues_of(int channels) {
  std::vector<Clue> out;
  for (int c = 0; c < channels; c++)
    for (const double sign : {-1.0, 1.0})
      if (c + 1 < channels || sign > 0) out.push_back({c, sign});
  return out;
}

/// From the coarsest scale on, where all clues are tried, to the finest, which takes most of the time and tries the
/// best of them.
BestPartition best_partition(const Planes& picture, const Task& task) {
  std::vector<Planes> responses;
  Planes level = picture;
  for (int s = 0; s < find_elements_tuning->scales && std::min(level.size.width, level.size.height) >= 16; s++) {
    task.check();
    responses.push_back(line_responses(level, task));
    level = halved(level);
  }
  BestPartition best;
  if (responses.empty()) return best;
  std::vector<Clue> clues = clues_of(responses.front().channels);
  for (size_t s = responses.size(); s-- > 0;) {
    if (s == 0 && responses.size() > 1) {
      std::ranges::stable_sort(clues, std::greater<>(), &Clue::quality);
      clues.resize(std::min(clues.size(), size_t(find_elements_tuning->clues)));
    }
    for (Clue& clue : clues) {
      task.check();
      const Planes& r = responses[s];
      VectorXd direction = VectorXd::Zero(r.channels);
      direction[clue.channel] = clue.sign;
      clue.quality = std::max(clue.quality, consider(along(r, direction), r, s, best));
    }
  }
  for (int round = 0; round < find_elements_tuning->rounds && best.quality > 0; round++) {
    task.check();
    const Planes& r = responses[best.scale];
    const double before = best.quality;
    if (const VectorXd direction = telling_direction(r, best.partition); direction.size() > 0)
      consider(along(r, direction), r, best.scale, best);
    if (best.quality <= before) break;
  }
  return best;
}

std::vector<uint8_t> relief_at_size(const BestPartition& found, Size size, bool wraps) {
  Planes relief = Planes::zeros(found.size, 1, wraps);
  std::copy(found.relief.begin(), found.relief.end(), relief.values.begin());
  relief = resampled(relief, size);
  std::vector<uint8_t> heights(size_t(size.area()));
  for (size_t i = 0; i < heights.size(); i++) heights[i] = uint8_t(relief.values[i]);
  return heights;
}

/// The partition at another size: what is well inside stays, and is flooded from there up to the lines.
std::vector<uint16_t> at_size(const BestPartition& found, const std::vector<uint8_t>& heights, Size size, bool wraps) {
  const std::vector<uint8_t> border = border_pixels(found.partition.regions.at, found.size, wraps);
  std::vector<uint32_t> seeds(heights.size(), no_region);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const int u = int(int64_t{x} * found.size.width / size.width),
                v = int(int64_t{y} * found.size.height / size.height);
      const size_t from = size_t(v) * size_t(found.size.width) + size_t(u);
      if (!border[from]) seeds[size_t(y) * size_t(size.width) + size_t(x)] = found.partition.regions.at[from];
    }
  const Regions regions = flooded(heights, size, wraps, std::move(seeds));
  return {regions.at.begin(), regions.at.end()};
}

/// What varies most in the exemplar, at a size that is quick to look at.
Planes picture_of(const Features& features, const Task& task) {
  const std::shared_ptr<const Planes> exemplar = weighted_planes(features, task);
  Planes smaller;
  const Planes* picture = exemplar.get();
  for (; std::max(picture->size.width, picture->size.height) > find_elements_tuning->most_side; picture = &smaller)
    smaller = halved(*picture);
  return leading_planes(*picture, find_elements_tuning->components, task);
}

}  // namespace

ElementsPtr find_elements(const Features& features, const Task& task) {
  const BestPartition found = best_partition(picture_of(features, task), task);
  if (found.quality <= 0) return nullptr;
  auto out = std::make_shared<Elements>();
  out->size = features.size();
  const std::vector<uint8_t> relief = relief_at_size(found, features.size(), features.wraps());
  out->at = at_size(found, relief, features.size(), features.wraps());
  out->count = found.partition.regions.count;
  out->certainty = std::clamp((found.partition.confidence() - find_elements_tuning->unsure) /
                                  (find_elements_tuning->sure - find_elements_tuning->unsure),
                              0.0, 1.0);
  return out;
}

}  // namespace terrazzo
