#include "core/analysis/repeats/wrap_detection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/analysis/repeats/regularity.h"
#include "core/analysis/space/weighting.h"
#include "core/base/tuning.h"
#include "core/image/image_ops.h"
#include "core/numeric/nearest.h"

namespace terrazzo {

namespace {

struct Tuning {
  double beside_seam = 1.5;
  double inside = 1.35;
  double slack = 1.25;
  double least_certainty = 0.75;
  double most_excess = 1.0 / 120;
  double quick_slack = 1;
  int window = 6;
  int samples = 64;
  int lines = 96;
  int enough_lines = 3;
  int steps = 512;
};
const Tunable<Tuning> tuning(
    "wrap_detection",
    {
        {&Tuning::beside_seam, "beside_seam", "steps beside it",
         "what the step across the seam may be. Higher: rough joints along borders go on; lower: parts cut out are "
         "seen",
         "not measured: taken over from the code before constants were listed"},
        {&Tuning::inside, "inside", "mean steps inside",
         "what the step across the seam may be. Higher: parts cut out are taken to wrap; lower: exemplars that wrap "
         "are not",
         "wrap_detection"},
        {&Tuning::slack, "slack", "misfits inside",
         "what windows across the seam may have. Higher: parts cut out are taken to wrap; lower: exemplars that wrap "
         "are not",
         "not measured: taken over from the code before constants were listed"},
        {&Tuning::least_certainty, "least_certainty", "certainty",
         "of a lattice that may deny it. Higher: only drawn patterns are denied; lower: cells that are none deny it",
         "not measured: taken over from the code before constants were listed"},
        {&Tuning::most_excess, "most_excess", "share of a side",
         "by which cells may come out uneven. Higher: less is denied; lower: imprecise lattices deny what wraps",
         "not measured: taken over from the code before constants were listed"},
        {&Tuning::quick_slack, "quick_slack", "of the distance",
         "by which a quick search may miss the nearest window. Higher: it takes less time but decides less",
         "wrap_detection", 0, 10},
        {&Tuning::window, "window", "pixels a side",
         "of the windows that are compared. Higher: larger features must fit; lower: less is unusual",
         "not measured: taken over from the code before constants were listed", 1},
        {&Tuning::samples, "samples", "windows", "along a seam or a line. Higher: their mean is surer; costs time",
         "not measured: bounds the time", 1},
        {&Tuning::lines, "lines", "lines inside",
         "across which windows may be as unusual. Higher: joints inside are not missed; costs time", "wrap_detection",
         1},
        {&Tuning::enough_lines, "enough_lines", "lines",
         "of those, so many must be. Higher: parts cut out are seen; lower: what wraps along a joint is",
         "wrap_detection"},
        {&Tuning::steps, "steps", "steps inside", "whose mean is taken. Higher: surer; costs time",
         "not measured: bounds the time", 1},
    });

/// How far a window is from the nearest of many windows elsewhere; a map at a border is judged by what it does inside.
class WindowSearch {
 public:
  explicit WindowSearch(const Image& map) : map_(map) {
    std::vector<float> windows;
    for (int i = 0; i < places; i++) {
      const uint64_t r = random_bits(11, i);
      places_[i] = {int(below(uint32_t(r), map.width() - side)), int(below(uint32_t(r >> 32), map.height() - side))};
      std::ranges::copy(window(places_[i][0], places_[i][1]), std::back_inserter(windows));
    }
    search_ = std::make_unique<NearestPoints>(windows, side * side * map.channels());
  }

  /// The distance to the nearest window that does not overlap the one at (x, y), which may lie across a border: at most
  /// 1 + slack times as much, never less.
  double nearest(int x, int y, double slack) const {
    const auto overlaps = [&](uint32_t i) {
      return std::abs(places_[i][0] - x) < side && std::abs(places_[i][1] - y) < side;
    };
    return std::sqrt(double(search_->find(window(x, y).data(), slack, overlaps).squared));
  }

 private:
  static constexpr int places = 3000;
  const int side = tuning->window;
  std::vector<float> window(int x, int y) const { return read_padded(map_, {x, y, side, side}, Outside::wrap); }
  const Image& map_;
  std::array<std::array<int, 2>, places> places_;
  std::unique_ptr<NearestPoints> search_;
};

std::vector<float> border_line(const Image& map, bool rows, int i) {
  const Size size = map.size();
  const int at = wrap(i, rows ? size.height : size.width);
  return map.read(rows ? Rect{0, at, size.width, 1} : Rect{at, 0, 1, size.height});
}

double distance(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t k = 0; k < a.size(); k++) sum += std::abs(double(a[k]) - b[k]);
  return sum;
}

/// Whether a line differs more from the map's means, by channel, than along itself.
bool stands_out(const std::vector<float>& line, const std::vector<double>& means) {
  const size_t channels = means.size();
  const double pixels = double(line.size() / channels);
  double between = 0, within = 0;
  for (size_t c = 0; c < channels; c++) {
    double mean = 0;
    for (size_t k = c; k < line.size(); k += channels) mean += line[k] / pixels;
    for (size_t k = c; k < line.size(); k += channels) within += (line[k] - mean) * (line[k] - mean) / pixels;
    between += (mean - means[c]) * (mean - means[c]);
  }
  return between > within;
}

/// Whether a joint seems to run along one of the borders.
bool has_joint_along_border(const Image& map) {
  const std::vector<float> pixels = map.pixels();
  std::vector<double> means(size_t(map.channels()), 0.0);
  for (size_t i = 0; i < pixels.size(); i++) means[i % means.size()] += pixels[i] / double(map.size().area());
  for (const bool rows : {true, false})
    for (const int i : {-1, 0})
      if (stands_out(border_line(map, rows, i), means)) return true;
  return false;
}

/// Whether values go on from one border to the other about as they do from pixel to pixel beside them.
bool goes_on(const Image& map, bool rows) {
  const auto line = [&](int i) { return border_line(map, rows, i); };
  return distance(line(-1), line(0)) <=
         tuning->beside_seam * std::max(distance(line(-2), line(-1)), distance(line(0), line(1)));
}

/// Whether values change across the seam about as much as they do from line to line inside. Of gravel that was cut out
/// anywhere, windows fit as well as any others, but no pixel fits its neighbour.
bool steps_alike(const Image& map, bool rows) {
  const int lines = rows ? map.height() : map.width(), apart = std::max(1, lines / tuning->steps);
  double sum = 0, most_inside = 0;
  int steps = 0;
  for (int i = 0; i + 1 < lines; i += apart, steps++) {
    const double step = distance(border_line(map, rows, i), border_line(map, rows, i + 1));
    sum += step;
    most_inside = std::max(most_inside, step);
  }
  return distance(border_line(map, rows, -1), border_line(map, rows, 0)) <=
         std::max(most_inside, tuning->inside * sum / steps);
}

/// How much less than windows inside those across a line look like the rest of their map, as a mean of all maps: 1 is
/// as much. Places are parts of 1, since maps may differ in size.
class Fit {
 public:
  explicit Fit(const std::vector<ImagePtr>& maps) : maps_(maps) {
    for (const ImagePtr& map : maps) {
      searches_.push_back(std::make_unique<WindowSearch>(*map));
      double sum = 0;
      for (int i = 0; i < samples; i++)
        sum += searches_.back()->nearest(inside(map->width(), {12, 0, i}), inside(map->height(), {12, 1, i}), 0);
      inside_.push_back(std::max(sum / samples, std::numeric_limits<double>::min()));
    }
  }

  double across_seam(bool rows) const { return across(rows, std::nullopt, 0); }
  /// Whether it is at least so much across a line. Few come near it, and a quick search tells which.
  bool reaches_across_line(bool rows, double place, double least) const {
    return across(rows, place, tuning->quick_slack) >= least && across(rows, place, 0) >= least;
  }

 private:
  static int at(double place, int extent) { return int(place * (extent - tuning->window)); }
  static int inside(int extent, std::array<int, 3> sample) {
    return at(unit_double(random_bits(sample[0], sample[1], sample[2])), extent);
  }
  /// Without a line, of windows across the seam.
  double across(bool rows, std::optional<double> line, double slack) const {
    double out = 0;
    for (size_t m = 0; m < maps_.size(); m++) {
      const int width = maps_[m]->width(), height = maps_[m]->height(), breadth = rows ? height : width;
      const int first = line ? at(*line, breadth) : breadth - tuning->window / 2;
      for (int i = 0; i < samples; i++) {
        const int along = inside(rows ? width : height, {13, rows ? 1 : 0, i});
        out += (rows ? searches_[m]->nearest(along, first, slack) : searches_[m]->nearest(first, along, slack)) /
               inside_[m];
      }
    }
    return out / (samples * double(maps_.size()));
  }

  const std::vector<ImagePtr>& maps_;
  std::vector<std::unique_ptr<WindowSearch>> searches_;
  std::vector<double> inside_;
  const int samples = tuning->samples;
};

/// Whether there are lines inside across which windows look as little like the rest as across the seam: joints are such
/// lines.
bool lines_fit_as_little(const Fit& fit, bool rows, double seam) {
  const int lines = tuning->lines, enough = tuning->enough_lines;
  int found = 0;
  for (int i = 0; i < lines && found < enough && found + lines - i >= enough; i++)
    found += fit.reaches_across_line(rows, double(i) / lines, seam) ? 1 : 0;
  return found >= enough;
}

/// Whether windows across the borders resemble the rest of the maps about as much as windows inside do, and values go
/// on there.
bool borders_fit(const Material& material) {
  std::vector<ImagePtr> maps;
  for (const Map& map : material.maps()) {
    if (std::min(map.image->width(), map.image->height()) < 2 * tuning->window) return false;
    maps.push_back(materialized(map.image));
  }
  const auto all = [&](auto&& holds) {
    return std::ranges::all_of(maps, [&](const ImagePtr& map) { return holds(*map); });
  };
  // What a joint along the border shows across the seam may come nowhere else: it is then judged by itself. Rarely
  // asked for.
  std::optional<bool> joint;
  const auto has_joint = [&] {
    if (!joint) joint = std::ranges::any_of(maps, [](const ImagePtr& map) { return has_joint_along_border(*map); });
    return *joint;
  };
  const auto steps_fit = [&](bool rows) {
    return all([&](const Image& map) { return steps_alike(map, rows) || (goes_on(map, rows) && has_joint()); });
  };
  if (!steps_fit(true) || !steps_fit(false)) return false;
  const Fit fit(maps);
  const auto windows_fit = [&](bool rows) {
    const double seam = fit.across_seam(rows);
    return seam <= tuning->slack || (all([&](const Image& map) { return goes_on(map, rows); }) &&
                                     (has_joint() || lines_fit_as_little(fit, rows, seam)));
  };
  return windows_fit(true) && windows_fit(false);
}

/// Whether the exemplar's cells, found without regard to its borders, come out uneven around it: an odd number of
/// chequered tiles has borders that go on smoothly, and yet like meets like there.
bool cells_deny(const Material& material, const Task& task) {
  const FeaturesPtr features = weighted_features(material, weights_of_chosen(material, {}), false);
  if (!may_have_lattice(*features, tuning->least_certainty, task)) return false;
  const Lattice lattice = find_lattice(*features, tuning->least_certainty, task).lattice;
  const Size size = material.size();
  return lattice.rank == 2 && !(lattice.fits(size, true, false, tuning->most_excess * size.width) &&
                                lattice.fits(size, false, true, tuning->most_excess * size.height));
}

}  // namespace

bool seems_to_tile(const Material& material, const Task& task) {
  return borders_fit(material) && !cells_deny(material, task);
}

}  // namespace terrazzo
