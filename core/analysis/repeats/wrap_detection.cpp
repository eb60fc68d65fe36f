#include "core/analysis/repeats/wrap_detection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/analysis/repeats/border_joints.h"
#include "core/analysis/repeats/regularity.h"
#include "core/analysis/repeats/seen_map.h"
#include "core/analysis/space/weighting.h"
#include "core/base/tuning.h"
#include "core/image/image_ops.h"
#include "core/numeric/nearest.h"

namespace terrazzo {

namespace {

struct WrapDetectionTuning {
  double beside_seam = 1.6;
  double inside = 1.35;
  double slack = 1.25;
  double least_certainty = 0.75;
  double most_excess = 1.0 / 120;
  double quick_slack = 1;
  int window = 6;
  int lines = 96;
  int enough_lines = 3;
  double least_seen = 0.25;
  double most_alike = 0.9;
};
const Tunable<WrapDetectionTuning> wrap_detection_tuning(
    "wrap_detection",
    {
        {&WrapDetectionTuning::beside_seam, "beside_seam", "steps beside it",
         "what the step across the seam may be. Higher: rough joints along borders go on; lower: parts cut out are "
         "seen",
         "wrap_detection"},
        {&WrapDetectionTuning::inside, "inside", "mean steps inside",
         "what the step across the seam may be. Higher: parts cut out are taken to wrap; lower: exemplars that wrap "
         "are not",
         "wrap_detection"},
        {&WrapDetectionTuning::slack, "slack", "misfits inside",
         "what windows across the seam may have. Higher: parts cut out are taken to wrap; lower: exemplars that wrap "
         "are not",
         "What each rule decides"},
        {&WrapDetectionTuning::least_certainty, "least_certainty", "certainty",
         "of a lattice that may deny it. Higher: only drawn patterns are denied; lower: cells that are none deny it",
         "What each rule decides"},
        {&WrapDetectionTuning::most_excess, "most_excess", "share of a side",
         "by which cells may come out uneven. Higher: less is denied; lower: imprecise lattices deny what wraps",
         "What each rule decides"},
        {&WrapDetectionTuning::quick_slack, "quick_slack", "of the distance",
         "by which a quick search may miss the nearest window. Higher: it takes less time but decides less",
         "wrap_detection", 0, 10},
        {&WrapDetectionTuning::window, "window", "pixels a side",
         "of the windows that are compared. Higher: larger features must fit; lower: less is unusual",
         "What each rule decides", 1},
        {&WrapDetectionTuning::lines, "lines", "lines inside",
         "across which windows may be as unusual. Higher: joints inside are not missed; costs time", "wrap_detection",
         1},
        {&WrapDetectionTuning::enough_lines, "enough_lines", "lines",
         "of those, so many must be. Higher: parts cut out are seen; lower: what wraps along a joint is",
         "wrap_detection"},
        {&WrapDetectionTuning::least_seen, "least_seen", "share of a border",
         "that a mask must leave. Higher: less is told of masked exemplars; lower: chance decides",
         "not measured: as many lines as are enough", 0, 1},
        {&WrapDetectionTuning::most_alike, "most_alike", "of the difference of any two lines",
         "which neighbours may have to tell anything. Higher: noise is taken to wrap; lower: fine grain that wraps is "
         "not",
         "not measured: white noise comes to 1 within a few hundredths", 0, 1},
    });

// They bound the time.
constexpr int window_samples = 64;  // windows along a seam or a line
constexpr int inner_steps = 512;    // inside, whose mean is taken

/// How far a window is from the nearest of many windows elsewhere; a map at a border is judged by what it does inside.
class WindowSearch {
 public:
  explicit WindowSearch(const SeenMap& map) : map_(*map.image) {
    std::vector<float> windows;
    for (int i = 0; i < places; i++) {
      const uint64_t r = random_bits(11, i);
      const std::array<int, 2> place = {int(below(uint32_t(r), map_.width() - side)),
                                        int(below(uint32_t(r >> 32), map_.height() - side))};
      if (!map.counts_all(place[0], place[1], side)) continue;
      places_.push_back(place);
      std::ranges::copy(window(place[0], place[1]), std::back_inserter(windows));
    }
    if (!places_.empty()) search_ = std::make_unique<NearestPoints>(windows, side * side * map_.channels());
  }

  /// Whether there are enough windows to find one like another.
  bool can_tell() const { return places_.size() >= places / 10; }

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
  const int side = wrap_detection_tuning->window;
  std::vector<float> window(int x, int y) const { return read_padded(map_, {x, y, side, side}, Outside::wrap); }
  const Image& map_;
  std::vector<std::array<int, 2>> places_;
  std::unique_ptr<NearestPoints> search_;
};

/// How much values change from one border to the other, and from line to line inside.
struct Steps {
  double seam = 0, beside = 0, mean = 0, most = 0;

  /// Of gravel that was cut out anywhere, windows fit as well as any others, but no pixel fits its neighbour.
  bool are_alike() const { return seam <= std::max(most, wrap_detection_tuning->inside * mean); }
  bool go_on() const { return seam <= wrap_detection_tuning->beside_seam * beside; }
};

Steps steps_of(const SeenMap& map, bool rows, const Task& task) {
  const int lines = rows ? map.image->height() : map.image->width(), apart = std::max(1, lines / inner_steps);
  Steps out{step_at(map, rows, 0).distance, std::max(step_at(map, rows, -1).distance, step_at(map, rows, 1).distance),
            0, 0};
  int steps = 0;
  for (int i = 0; i + 1 < lines; i += apart) {
    task.check();
    const LineStep step = step_at(map, rows, i + 1);
    if (step.seen == 0) continue;
    steps++;
    out.mean += step.distance;
    out.most = std::max(out.most, step.distance);
  }
  out.mean /= std::max(1, steps);
  return out;
}

/// How much less than windows inside those across a line look like the rest of their map, as a mean of all maps: 1 is
/// as much. Places are parts of 1, since maps may differ in size.
class Fit {
 public:
  Fit(const std::vector<SeenMap>& maps, const Task& task) : maps_(maps) {
    for (const SeenMap& map : maps) {
      task.check();
      const WindowSearch& search = *searches_.emplace_back(std::make_unique<WindowSearch>(map));
      if (!search.can_tell()) return;
      Mean mean;
      for (int i = 0; i < window_samples; i++) {
        const int x = inside(map.image->width(), {12, 0, i}), y = inside(map.image->height(), {12, 1, i});
        if (map.counts_all(x, y, wrap_detection_tuning->window)) mean.add(search.nearest(x, y, 0));
      }
      if (mean.count == 0) return;
      inside_.push_back(std::max(mean.value(), std::numeric_limits<double>::min()));
    }
  }

  /// Whether enough of all maps counts.
  bool can_tell() const { return inside_.size() == maps_.size(); }

  double across_seam(bool rows) const { return across(rows, std::nullopt, 0); }
  /// Whether it is at least so much across a line. Few come near it, and a quick search tells which.
  bool reaches_across_line(bool rows, double place, double least) const {
    return across(rows, place, wrap_detection_tuning->quick_slack) >= least && across(rows, place, 0) >= least;
  }

 private:
  struct Mean {
    double sum = 0;
    int count = 0;
    void add(double v) { sum += v, count++; }
    double value() const { return sum / count; }
  };
  static int at(double place, int extent) { return int(place * (extent - wrap_detection_tuning->window)); }
  static int inside(int extent, std::array<int, 3> sample) {
    return at(unit_double(random_bits(sample[0], sample[1], sample[2])), extent);
  }
  /// Without a line, of windows across the seam. 0 if none counts.
  double across(bool rows, std::optional<double> line, double slack) const {
    double out = 0;
    for (size_t m = 0; m < maps_.size(); m++) {
      const int width = maps_[m].image->width(), height = maps_[m].image->height(), breadth = rows ? height : width;
      const int first = line ? at(*line, breadth) : breadth - wrap_detection_tuning->window / 2;
      Mean mean;
      for (int i = 0; i < window_samples; i++) {
        const int along = inside(rows ? width : height, {13, rows ? 1 : 0, i});
        const int x = rows ? along : first, y = rows ? first : along;
        if (maps_[m].counts_all(x, y, wrap_detection_tuning->window))
          mean.add(searches_[m]->nearest(x, y, slack) / inside_[m]);
      }
      if (mean.count > 0) out += mean.value();
    }
    return out / double(maps_.size());
  }

  const std::vector<SeenMap>& maps_;
  std::vector<std::unique_ptr<WindowSearch>> searches_;
  std::vector<double> inside_;
};

/// Whether there are lines inside across which windows look as little like the rest as across the seam: joints are such
/// lines.
bool lines_fit_as_little(const Fit& fit, bool rows, double seam, const Task& task) {
  const int lines = wrap_detection_tuning->lines, enough = wrap_detection_tuning->enough_lines;
  int found = 0;
  for (int i = 0; i < lines && found < enough && found + lines - i >= enough; i++) {
    task.check();
    found += fit.reaches_across_line(rows, double(i) / lines, seam) ? 1 : 0;
  }
  return found >= enough;
}

/// What the borders of all maps show. What is rarely asked for is looked for when it is.
class Borders {
 public:
  Borders(const std::vector<SeenMap>& maps, const Task& task) : maps_(maps) {
    for (const bool rows : {true, false})
      for (const SeenMap& map : maps) {
        if (step_at(map, rows, 0).seen < wrap_detection_tuning->least_seen) return;
        steps_[rows].push_back(steps_of(map, rows, task));
      }
    sees_enough_ = true;
  }

  const std::vector<SeenMap>& maps() const { return maps_; }
  bool sees_enough() const { return sees_enough_; }
  /// What a joint along the border shows across the seam may come nowhere else: it is then judged by itself.
  bool have_joint() const {
    if (!joint_) joint_ = std::ranges::any_of(maps_, has_joint_along_border);
    return *joint_;
  }
  /// A joint that comes again inside.
  bool joint_recurs(bool rows) const {
    if (!recurs_[rows])
      recurs_[rows] = std::ranges::any_of(maps_, [&](const SeenMap& map) { return is_joint_that_recurs(map, rows); });
    return *recurs_[rows];
  }
  /// The same, or a step along both axes: chequered tiles.
  bool recurs(bool rows) const {
    if (!steps_recur_)
      steps_recur_ = std::ranges::any_of(
          maps_, [](const SeenMap& map) { return is_step_that_recurs(map, true) && is_step_that_recurs(map, false); });
    return joint_recurs(rows) || *steps_recur_;
  }
  bool steps_fit(bool rows) const {
    return all(rows, [&](const Steps& s, const SeenMap& map) {
      return s.are_alike() || recurs(rows) || joint_goes_on(s, map, rows);
    });
  }
  bool joint_goes_on(bool rows) const {
    return all(rows, [&](const Steps& s, const SeenMap& map) { return joint_goes_on(s, map, rows); });
  }
  bool go_on(bool rows) const {
    return all(rows, [](const Steps& s, const SeenMap&) { return s.go_on(); });
  }
  bool may_part_tiles(bool rows) const {
    return go_on(rows) || joint_recurs(rows) ||
           std::ranges::any_of(maps_, [&](const SeenMap& map) { return is_joint(map, rows); });
  }

 private:
  bool joint_goes_on(const Steps& s, const SeenMap& map, bool rows) const {
    return (s.go_on() && have_joint()) || is_joint_by_itself(map, rows);
  }
  template <typename Holds>
  bool all(bool rows, const Holds& holds) const {
    for (size_t i = 0; i < maps_.size(); i++)
      if (!holds(steps_[rows][i], maps_[i])) return false;
    return true;
  }

  const std::vector<SeenMap>& maps_;
  std::array<std::vector<Steps>, 2> steps_;  // of each map, along columns and rows
  bool sees_enough_ = false;
  mutable std::optional<bool> joint_, steps_recur_;
  mutable std::array<std::optional<bool>, 2> recurs_;
};

bool steps_fit(const Borders& borders) {
  return borders.sees_enough() && borders.steps_fit(true) && borders.steps_fit(false);
}

/// Whether windows across the borders resemble the rest of the maps about as much as windows inside do.
bool windows_fit(const Borders& borders, const Task& task) {
  const Fit fit(borders.maps(), task);
  return fit.can_tell() && std::ranges::all_of(std::array{true, false}, [&](bool rows) {
           const double seam = fit.across_seam(rows);
           return seam <= wrap_detection_tuning->slack || borders.recurs(rows) || borders.joint_goes_on(rows) ||
                  (borders.go_on(rows) && lines_fit_as_little(fit, rows, seam, task));
         });
}

/// Whether neighbouring lines are more alike than any two: the borders of white noise fit together wherever it is cut.
bool neighbours_are_alike(const SeenMap& map, bool rows) {
  const auto lines = uint32_t(rows ? map.image->height() : map.image->width());
  double neighbours = 0, any_two = 0;
  for (int i = 0; i < window_samples; i++) {
    const uint64_t r = random_bits(14, rows ? 1 : 0, i);
    const int at = int(below(uint32_t(r), lines - 1)) + 1, other = int(below(uint32_t(r >> 32), lines));
    neighbours += step_at(map, rows, at).distance;
    any_two += step_between(line_of(map, rows, at), line_of(map, rows, other)).distance;
  }
  return neighbours <= wrap_detection_tuning->most_alike * any_two;
}

FeaturesPtr features_of(const Material& material, bool wraps, const ImagePtr& mask) {
  return weighted_features(material, weights_of_chosen(material, {}), wraps, mask);
}

/// Whether the exemplar's cells, found without regard to its borders, come out uneven around it: an odd number of
/// chequered tiles has borders that go on smoothly, and yet like meets like there.
bool cells_deny(const Material& material, const ImagePtr& mask, const Task& task) {
  const FeaturesPtr features = features_of(material, false, mask);
  if (!may_have_lattice(*features, wrap_detection_tuning->least_certainty, task)) return false;
  const Lattice lattice = find_lattice(*features, wrap_detection_tuning->least_certainty, task).lattice;
  const Size size = material.size();
  return lattice.rank == 2 && !(lattice.fits(size, true, false, wrap_detection_tuning->most_excess * size.width) &&
                                lattice.fits(size, false, true, wrap_detection_tuning->most_excess * size.height));
}

/// Whether few tiles, parted as if the exemplar tiled, lie in cells around its borders: joints that those cut in halves
/// fit nothing inside.
bool few_cells_tell(const Material& material, const ImagePtr& mask, const Task& task) {
  const Lattice of_few = told_by_few_elements(*features_of(material, true, mask), {}, task).lattice;
  return of_few.rank == 2 && !of_few.is_single_cell(material.size());
}

/// Whether joints cross and, if the exemplar tiled, all of it would be one cell: panels in a frame, whose sides may
/// differ as they like.
bool is_framed_panel(const Material& material, const ImagePtr& mask, const Task& task) {
  const auto found = [&](bool wraps) {
    return find_lattice(*features_of(material, wraps, mask), least_lattice_certainty, task);
  };
  return found(false).too_few && found(true).lattice.is_single_cell(material.size());
}

}  // namespace

bool borders_meet(const Material& material, const Task& task) {
  const std::vector<SeenMap> maps = seen_maps(material, nullptr, 2 * wrap_detection_tuning->window, task);
  const auto tell = [&](bool rows) {
    return std::ranges::any_of(maps, [&](const SeenMap& map) { return neighbours_are_alike(map, rows); });
  };
  if (!tell(true) || !tell(false)) return false;
  const Borders borders(maps, task);
  return steps_fit(borders) && windows_fit(borders, task);
}

bool seems_to_tile(const Material& material, const Task& task, const ImagePtr& mask) {
  const std::vector<SeenMap> maps = seen_maps(material, mask, 2 * wrap_detection_tuning->window, task);
  if (maps.empty()) return false;
  const Borders borders(maps, task);
  const bool fit = steps_fit(borders);
  // A joint that recurs lies exactly where cells begin, which a lattice found without the borders does not tell.
  if (fit && windows_fit(borders, task) &&
      (!cells_deny(material, mask, task) || (borders.joint_recurs(true) && borders.joint_recurs(false))))
    return true;
  return borders.sees_enough() && borders.have_joint() && borders.may_part_tiles(true) &&
         borders.may_part_tiles(false) &&
         ((fit && few_cells_tell(material, mask, task)) || is_framed_panel(material, mask, task));
}

}  // namespace terrazzo
