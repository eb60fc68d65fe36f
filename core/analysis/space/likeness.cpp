#include "core/analysis/space/likeness.h"

#include <algorithm>
#include <cmath>

#include "core/analysis/space/weighting.h"
#include "core/base/tuning.h"
#include "core/filter/resample.h"

namespace terrazzo {

namespace {

struct LikenessTuning {
  double least = 0.6;
  int fewest_cells = 64;
};
const Tunable<LikenessTuning> likeness_tuning(
    "likeness", {
                    {&LikenessTuning::least, "least", "correlation",
                     "from which on a material is the analysed one. Higher: a repainted map passes for another; lower: "
                     "other materials pass",
                     "likeness"},
                    {&LikenessTuning::fewest_cells, "fewest_cells", "cells",
                     "that tell materials apart. Higher: small exemplars are not compared; lower: some correlate by "
                     "chance",
                     "not measured: 64 cells correlate by chance with a standard deviation of 1/8", 4},
                });

/// A cell is at least this many pixels a side, so that rounding to whole pixels does not move it.
constexpr int smallest_cell = 4;

Size cells_of(Size exemplar) {
  const auto along = [](int side) { return std::clamp(side / smallest_cell, 1, Fingerprint::most_cells); };
  return {along(exemplar.width), along(exemplar.height)};
}

/// What a cell has more than those around it: what is where, whatever the light on a scan does as a whole.
template <typename T>
std::vector<double> details(const T* values, int stride, Size cells) {
  constexpr int around = 2;
  std::vector<double> out;
  out.reserve(size_t(cells.area()));
  for (int y = 0; y < cells.height; y++)
    for (int x = 0; x < cells.width; x++) {
      double sum = 0;
      int count = 0;
      for (int j = std::max(0, y - around); j <= std::min(cells.height - 1, y + around); j++)
        for (int i = std::max(0, x - around); i <= std::min(cells.width - 1, x + around); i++, count++)
          sum += double(values[(size_t(j) * cells.width + i) * stride]);
      out.push_back(double(values[(size_t(y) * cells.width + x) * stride]) - sum / count);
    }
  return out;
}

/// 0 if one of them is of one value.
double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double product = 0, square_a = 0, square_b = 0;
  for (size_t i = 0; i < a.size(); i++) {
    product += a[i] * b[i];
    square_a += a[i] * a[i];
    square_b += b[i] * b[i];
  }
  const double size = std::sqrt(square_a * square_b);
  return size > 0 && std::isfinite(size) ? product / size : 0;
}

/// How a map's cells come to be in analysis space.
enum class CellMeans {
  quick,  ///< from the means of the map's own values
  exact,  ///< as means of what is compared in the analysis: of dark grain they differ
};

/// A map's cells in analysis space.
std::vector<float> cells_of(const Map& map, Size cells, CellMeans means, int& channels) {
  const bool quick = means == CellMeans::quick;
  const ImagePtr image = quick ? map.image : analysis_image(map.image);
  const Digest recipe = Hasher().add("cells").add(image->digest()).add(cells.width).add(cells.height).digest();
  ImagePtr small = resampled(image, cells, "box", Outside::clamp, recipe);
  if (quick) small = analysis_image(small);
  channels = small->channels();
  std::vector<float> pixels(size_t(cells.area()) * channels);
  small->read(whole(cells), pixels.data());
  return pixels;
}

Likeness likeness_by(CellMeans means, const Fingerprint& analysed, const Material& material, const Task& task) {
  Likeness best;
  for (const Map& map : material.maps()) {
    int channels = 0;
    std::vector<float> cells;
    for (const Fingerprint::Channel& c : analysed.channels) {
      if (c.map != map.name || c.map.empty()) continue;
      task.check();
      if (cells.empty()) cells = cells_of(map, analysed.cells, means, channels);
      if (c.channel >= channels) continue;
      if (best.maps.empty() || best.maps.back() != map.name) best.maps.push_back(map.name);
      best.correlation =
          std::max(best.correlation, std::abs(correlation(details(c.means.data(), 1, analysed.cells),
                                                          details(&cells[c.channel], channels, analysed.cells))));
    }
    if (best.correlation >= likeness_tuning->least) break;
  }
  return best;
}

}  // namespace

Fingerprint fingerprint_of(const Features& features, const Planes& channels) {
  Fingerprint out{.cells = cells_of(features.size()), .channels = {}};
  const Planes means = resampled(channels, out.cells);
  int plane = 0;
  for (const FeatureImage& f : features.images())
    for (size_t c = 0; c < f.weights.size(); c++) {
      if (f.weights[c] <= 0) continue;
      float least = means.values[plane], most = least;
      for (size_t i = plane; i < means.values.size(); i += means.channels) {
        least = std::min(least, means.values[i]);
        most = std::max(most, means.values[i]);
      }
      if (std::isfinite(most - least) && most > least) {
        Fingerprint::Channel channel{.map = f.map, .channel = int(c), .means = {}};
        for (size_t i = plane; i < means.values.size(); i += means.channels)
          channel.means.push_back(uint8_t((means.values[i] - least) / (most - least) * 255 + 0.5f));
        out.channels.push_back(std::move(channel));
      }
      plane++;
    }
  return out;
}

std::optional<Likeness> likeness(const Fingerprint& analysed, const Material& material, const Task& task) {
  if (analysed.cells.area() < likeness_tuning->fewest_cells) return {};
  Likeness best = likeness_by(CellMeans::quick, analysed, material, task);
  if (best.maps.empty()) return {};
  if (best.correlation < likeness_tuning->least) best = likeness_by(CellMeans::exact, analysed, material, task);
  return best;
}

double least_likeness() {
  return likeness_tuning->least;
}

}  // namespace terrazzo
