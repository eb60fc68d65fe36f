#include "core/analysis/repeats/uneven_borders.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/analysis/repeats/exemplar_view.h"
#include "core/analysis/space/planes.h"
#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct UnevenBordersTuning {
  double least = 3.5;
  double inwards = 2;
  double least_change = 0.6;
  double least_seen = 0.5;
};
const Tunable<UnevenBordersTuning> uneven_borders_tuning(
    "uneven_borders",
    {{&UnevenBordersTuning::least, "least", "deviations of the strips inside",
      "by which the outermost strip must differ. Higher: dark borders come in patches; lower: grounds that change "
      "slowly lose some of what they show",
      "uneven_borders"},
     {&UnevenBordersTuning::inwards, "inwards", "deviations of the strips inside",
      "by which those must differ that are left out with it. Higher: what fades out stays; lower: more is left out",
      "uneven_borders"},
     {&UnevenBordersTuning::least_change, "least_change", "share of the variance of parts",
      "that lies between strips where an exemplar changes from side to side. Higher: fewer are warned of; lower: "
      "grounds with a large stain are",
      "uneven_borders", 0, 1},
     {&UnevenBordersTuning::least_seen, "least_seen", "deviations of the whole exemplar",
      "by which its sides must differ. Higher: fewer are warned of; lower: changes that hardly show are",
      "uneven_borders"}});

constexpr int border_strips = 16;               ///< from border to border
constexpr int most_strips = border_strips / 4;  ///< of a border; those farther inside are compared with
constexpr int least_strips = 2;                 ///< one alone may be a joint, or chance
constexpr int least_pixels = 4;                 ///< of a strip's breadth
constexpr double flat = 0.1;                    ///< deviations of the whole exemplar: smaller differences do not show

/// Of all channels together.
double variance_of(const Planes& planes) {
  const Moments<> moments = channel_moments(planes);
  double sum = 0;
  for (int c = 0; c < planes.channels; c++) sum += moments.variance(c);
  return sum;
}

/// The mean tone of a strip. `strips`: one pixel for each.
const float* tone(const Planes& strips, int i) {
  return &strips.values[size_t(i) * size_t(strips.channels)];
}

Moments<> moments_of(const Planes& strips, int first, int count) {
  Moments<> out(strips.channels);
  for (int i = first; i < first + count; i++) out.add(tone(strips, i));
  return out;
}

/// Whether most of what differs between parts differs between strips, and between those of two sides so that it shows.
bool changes_as_a_whole(const Planes& parts, const Planes& strips, double variance) {
  if (variance_of(strips) < uneven_borders_tuning->least_change * variance_of(parts)) return false;
  const auto first = moments_of(strips, 0, most_strips).mean_vector();
  const auto last = moments_of(strips, border_strips - most_strips, most_strips).mean_vector();
  const double seen = uneven_borders_tuning->least_seen;
  return (first - last).squaredNorm() >= seen * seen * variance && variance > 0;
}

/// By how much a tone differs from those inside, in the channel that differs most.
double difference(const float* tone, const Moments<>& inside, int channels) {
  double most = 0;
  for (int c = 0; c < channels; c++)
    most = std::max(most, std::abs(double(tone[c]) - inside.mean(c)) / (std::sqrt(inside.variance(c)) + flat));
  return most;
}

/// How many strips are unlike those inside, from the first or from the last on.
int count_uneven(const Planes& strips, bool from_last) {
  const Moments<> inside = moments_of(strips, most_strips, border_strips - 2 * most_strips);
  const auto differs = [&](int i, double by) {
    return difference(tone(strips, from_last ? border_strips - 1 - i : i), inside, strips.channels) >= by;
  };
  if (!differs(0, uneven_borders_tuning->least)) return 0;
  int count = 1;
  while (count < most_strips && differs(count, uneven_borders_tuning->inwards)) count++;
  return count < least_strips ? 0 : count;
}

}  // namespace

Evenness evenness(const Features& features, const Task& task) {
  const Size size = features.size();
  Evenness out{whole(size)};
  const Lattice& lattice = features.repeats().lattice;
  if (features.wraps() || features.mask() || lattice.is_single_cell(size)) return out;
  const Planes planes = view_of(*weighted_planes(features, task), {}, whole(size)).planes;
  if (std::min(planes.size.width, planes.size.height) < border_strips * least_pixels) return out;
  const Planes parts = resampled(planes, {border_strips, border_strips});
  const Planes rows = resampled(parts, {1, border_strips}), columns = resampled(parts, {border_strips, 1});
  const bool in_courses = lattice.rank == 1 && lattice.first.x() == 0;
  const bool in_columns = lattice.rank == 1 && !in_courses;
  const auto uneven = [](const Planes& strips, bool from_last, int side) {
    return int(int64_t{count_uneven(strips, from_last)} * side / border_strips);
  };
  if (lattice.rank < 2 && !in_columns) {
    out.part.x = uneven(columns, false, size.width);
    out.part.width -= out.part.x + uneven(columns, true, size.width);
  }
  if (lattice.rank < 2 && !in_courses) {
    out.part.y = uneven(rows, false, size.height);
    out.part.height -= out.part.y + uneven(rows, true, size.height);
  }
  if (out.part != whole(size)) return out;
  const double variance = variance_of(planes);
  // Cells of more than half the exemplar keep all of it in place.
  const bool high = lattice.rank == 2 && 2 * std::abs(lattice.along_bands(false).y()) > size.height;
  const bool wide = lattice.rank == 2 && 2 * std::abs(lattice.along_bands(true).x()) > size.width;
  out.changes_down = !in_courses && !high && changes_as_a_whole(parts, rows, variance);
  out.changes_across = !in_columns && !wide && changes_as_a_whole(parts, columns, variance);
  return out;
}

}  // namespace terrazzo
