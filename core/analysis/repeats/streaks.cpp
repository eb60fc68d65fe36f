#include "core/analysis/repeats/streaks.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/analysis/space/appearance_space.h"
#include "core/analysis/space/planes.h"
#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct StreaksTuning {
  double most_lost = 0.15;
  double least_counted = 0.02;
  double surest_courses = 0.8;
  double least_sure = 0.2;
  double fewest_courses = 3;
  int longest_step = 8;
};
const Tunable<StreaksTuning> streaks_tuning(
    "streaks",
    {{&StreaksTuning::most_lost, "most_lost", "share of what the same loses across",
      "of the variance that goes when streaks are shortened. Higher: bricks and boards count as streaks, and lose "
      "their ends; lower: grain with a few knots is cut by upright seams",
      "streaks", 0, 1},
     {&StreaksTuning::least_counted, "least_counted", "share of the variance lost",
      "in a part of the exemplar, from which on it has a say. Higher: streaks may end in faint features; lower: noise "
      "in plain parts hides them",
      "streaks", 0, 1},
     {&StreaksTuning::surest_courses, "surest_courses", "certainty",
      "of courses or columns whose streaks are shortened. Higher: boards are cut by upright seams; lower: pipes that "
      "lie at uneven distances end anywhere",
      "streaks", 0, 1},
     {&StreaksTuning::least_sure, "least_sure", "certainty",
      "of courses or columns of streaks that are more than chance. Higher: boards end anywhere; lower: brushed metal "
      "repeats",
      "streaks", 0, 1},
     {&StreaksTuning::fewest_courses, "fewest_courses", "courses",
      "that an exemplar must hold for those that are less sure to be more than chance. Higher: pipes and boards change "
      "their distances; lower: grain repeats",
      "streaks", 1},
     {&StreaksTuning::longest_step, "longest_step", "pixels",
      "that count as one. Higher: streaks end one by one; lower: several end side by side", "streaks", 1,
      longest_streak_step}});

constexpr double noise = 1;      ///< pixels by which single pixels' noise is blurred away
constexpr int parts_a_side = 4;  ///< each of the exemplar's parts must have streaks

/// The variance within runs of so many pixels along an axis, summed over each part of the planes.
class LossByPart {
 public:
  LossByPart(const Planes& planes, int run, bool along_x) : sums_(size_t(parts_a_side * parts_a_side)) {
    const Size size = planes.size;
    const int steps = (along_x ? size.width : size.height) / run, rows = along_x ? size.height : size.width;
    std::vector<double> mean(size_t(planes.channels));
    for (int row = 0; row < rows; row++)
      for (int step = 0; step < steps; step++) {
        const auto at = [&](int i) {
          return along_x ? planes.at(step * run + i, row) : planes.at(row, step * run + i);
        };
        std::ranges::fill(mean, 0.0);
        for (int i = 0; i < run; i++)
          for (int c = 0; c < planes.channels; c++) mean[size_t(c)] += at(i)[c] / double(run);
        double lost = 0;
        for (int i = 0; i < run; i++)
          for (int c = 0; c < planes.channels; c++) lost += (at(i)[c] - mean[size_t(c)]) * (at(i)[c] - mean[size_t(c)]);
        const int along = step * parts_a_side / steps, across = row * parts_a_side / rows;
        sums_[size_t(along_x ? across * parts_a_side + along : along * parts_a_side + across)] += lost;
      }
  }

  double of(size_t part) const { return sums_[part]; }
  double mean() const {
    double sum = 0;
    for (const double s : sums_) sum += s;
    return sum / double(sums_.size());
  }

 private:
  std::vector<double> sums_;
};

/// Whether runs of so many pixels can be shown as one along x, or along y, at little loss.
std::array<bool, 2> can_shorten(const Planes& planes, int run) {
  const LossByPart x(planes, run, true), y(planes, run, false);
  const double least = streaks_tuning->least_counted * (x.mean() + y.mean());
  std::array<bool, 2> can{least > 0, least > 0};
  for (size_t part = 0; part < size_t(parts_a_side * parts_a_side); part++) {
    can[0] &= x.of(part) + least <= streaks_tuning->most_lost * (y.of(part) + least);
    can[1] &= y.of(part) + least <= streaks_tuning->most_lost * (x.of(part) + least);
  }
  return can;
}

/// Of an exemplar whose courses, or columns, are `across`; (0, 0): it has none.
Streaks find_streaks(const Features& features, Vector2d across, const Task& task) {
  const Size size = features.size();
  const Planes planes = blurred(*weighted_planes(features, task), noise, Beyond::as_it_wraps, task);
  const int least_levels = across == Vector2d{0, 0} ? 2 : 3;  // courses must be seen from afar
  const auto leaves_enough = [&](int side, int run) {
    return appearance_levels({side / run, side / run}) >= least_levels && (!features.wraps() || side % run == 0);
  };
  Streaks found;
  for (int run = 2; run <= streaks_tuning->longest_step; run *= 2) {
    task.check();
    const std::array<bool, 2> can = can_shorten(planes, run);
    const bool x = can[0] && across.x() == 0 && found.x * 2 == run && leaves_enough(size.width, run);
    const bool y = can[1] && across.y() == 0 && found.y * 2 == run && leaves_enough(size.height, run);
    if (x) found.x = run;
    if (y) found.y = run;
    if (!x && !y) break;
  }
  return found;
}

/// Whether courses, or columns, that are not sure have come about by chance: they follow one another along the streaks,
/// are hardly alike, or the exemplar holds few of them. Those of one that tiles are found by lines that go straight
/// through it.
bool is_chance(const Lattice& lattice, const Streaks& streaks, const Features& features) {
  const bool across_x = streaks.y > 1;
  const bool along = across_x ? lattice.first.y() != 0 : lattice.first.x() != 0;
  const double side = across_x ? features.size().width : features.size().height;
  return along || lattice.certainty < streaks_tuning->least_sure ||
         (!features.wraps() && lattice.first.norm() * streaks_tuning->fewest_courses > side);
}

}  // namespace

Repeats with_streaks(const Features& features, const Task& task) {
  Repeats repeats = features.repeats();
  const Lattice lattice = repeats.lattice;
  if (features.mask() || features.elements() || lattice.rank == 2 || !repeats.parts.empty()) return repeats;
  const bool sure = lattice.rank == 0 || lattice.certainty >= streaks_tuning->surest_courses;
  const Streaks found = find_streaks(features, lattice.rank == 1 && sure ? lattice.first : Vector2d{0, 0}, task);
  if (!found.any()) return repeats;
  if (!sure) {
    if (!is_chance(lattice, found, features)) return repeats;
    repeats.lattice = {0, {}, {}, lattice.certainty};
  }
  repeats.streaks = found;
  return repeats;
}

}  // namespace terrazzo
