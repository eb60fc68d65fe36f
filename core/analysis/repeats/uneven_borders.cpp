#include "core/analysis/repeats/uneven_borders.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

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
      "grounds "
      "with a large stain are",
      "uneven_borders", 0, 1},
     {&UnevenBordersTuning::least_seen, "least_seen", "deviations of the whole exemplar",
      "by which its sides must differ. Higher: fewer are warned of; lower: changes that hardly show are",
      "uneven_borders"}});

constexpr int border_strips = 16;               ///< from border to border
constexpr int most_strips = border_strips / 4;  ///< of a border; those farther inside are compared with
constexpr int least_strips = 2;                 ///< one alone may be a joint, or chance
constexpr int least_pixels = 4;                 ///< of a strip's breadth
constexpr double flat = 0.1;                    ///< deviations of the whole exemplar: smaller differences do not show

using Tone = std::vector<double>;  // a mean per channel

/// The mean tones of the parts where a strip along rows meets one along columns.
std::vector<Tone> tones_of_parts(const Planes& planes) {
  std::vector<Tone> out(size_t(border_strips) * border_strips, Tone(size_t(planes.channels), 0.0));
  std::vector<int64_t> pixels(out.size(), 0);
  const Size size = planes.size;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const auto part =
          size_t(int64_t{y} * border_strips / size.height * border_strips + int64_t{x} * border_strips / size.width);
      const float* value = planes.at(x, y);
      for (int c = 0; c < planes.channels; c++) out[part][size_t(c)] += double(value[c]);
      pixels[part]++;
    }
  for (size_t i = 0; i < out.size(); i++)
    for (double& v : out[i]) v /= double(pixels[i]);
  return out;
}

/// Those of strips along rows (or columns), from the first border to the other.
std::vector<Tone> tones_of_strips(const std::vector<Tone>& parts, bool rows) {
  std::vector<Tone> out(size_t(border_strips), Tone(parts.front().size(), 0.0));
  for (size_t i = 0; i < parts.size(); i++)
    for (size_t c = 0; c < parts[i].size(); c++)
      out[rows ? i / border_strips : i % border_strips][c] += parts[i][c] / border_strips;
  return out;
}

Tone mean_of(const std::vector<Tone>& tones) {
  Tone out(tones.front().size(), 0.0);
  for (const Tone& t : tones)
    for (size_t c = 0; c < t.size(); c++) out[c] += t[c] / double(tones.size());
  return out;
}

double squared_distance(const Tone& a, const Tone& b) {
  double sum = 0;
  for (size_t c = 0; c < a.size(); c++) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

/// Of all channels together.
double variance_of(const std::vector<Tone>& tones) {
  const Tone mean = mean_of(tones);
  double sum = 0;
  for (const Tone& t : tones) sum += squared_distance(t, mean) / double(tones.size());
  return sum;
}

double variance_of(const Planes& planes) {
  std::vector<double> sums(size_t(planes.channels), 0.0), squares(size_t(planes.channels), 0.0);
  for (size_t i = 0; i < planes.values.size(); i++) {
    const auto v = double(planes.values[i]);
    sums[i % size_t(planes.channels)] += v;
    squares[i % size_t(planes.channels)] += v * v;
  }
  const auto count = double(planes.size.area());
  double out = 0;
  for (size_t c = 0; c < sums.size(); c++) out += squares[c] / count - sums[c] / count * (sums[c] / count);
  return out;
}

/// Whether most of what differs between parts differs between strips, and between those of two sides so that it shows.
bool changes_as_a_whole(const std::vector<Tone>& parts, const std::vector<Tone>& strips_of_them, double variance) {
  if (variance_of(strips_of_them) < uneven_borders_tuning->least_change * variance_of(parts)) return false;
  const Tone first = mean_of({strips_of_them.begin(), strips_of_them.begin() + most_strips});
  const Tone last = mean_of({strips_of_them.end() - most_strips, strips_of_them.end()});
  const double seen = uneven_borders_tuning->least_seen;
  return squared_distance(first, last) >= seen * seen * variance && variance > 0;
}

/// How the tones of strips inside vary, per channel.
struct Inside {
  Tone mean, unit;
};

Inside inside_of(const std::vector<Tone>& tones) {
  const auto mean = [&](const auto& value) {
    double sum = 0;
    for (int i = most_strips; i < border_strips - most_strips; i++) sum += value(tones[size_t(i)]);
    return sum / (border_strips - 2 * most_strips);
  };
  Inside out;
  for (size_t c = 0; c < tones.front().size(); c++) {
    const double middle = mean([&](const Tone& t) { return t[c]; });
    const double variance = mean([&](const Tone& t) { return (t[c] - middle) * (t[c] - middle); });
    out.mean.push_back(middle);
    out.unit.push_back(std::sqrt(variance) + flat);
  }
  return out;
}

/// By how much a tone differs in the channel that differs most.
double difference(const Tone& tone, const Inside& inside) {
  double most = 0;
  for (size_t c = 0; c < tone.size(); c++) most = std::max(most, std::abs(tone[c] - inside.mean[c]) / inside.unit[c]);
  return most;
}

/// How many strips are unlike those inside, from the first on.
int count_uneven(const std::vector<Tone>& tones, const Inside& inside) {
  if (difference(tones.front(), inside) < uneven_borders_tuning->least) return 0;
  int count = 1;
  while (count < most_strips && difference(tones[size_t(count)], inside) >= uneven_borders_tuning->inwards) count++;
  return count < least_strips ? 0 : count;
}

struct UnevenBorders {
  int first = 0, last = 0;  ///< strips along two opposite borders
};

UnevenBorders uneven_borders(std::vector<Tone> tones) {
  const Inside inside = inside_of(tones);
  const int first = count_uneven(tones, inside);
  std::reverse(tones.begin(), tones.end());
  return {first, count_uneven(tones, inside)};
}

}  // namespace

Evenness evenness(const Features& features, const Task& task) {
  const Size size = features.size();
  Evenness out{whole(size)};
  const Lattice& lattice = features.repeats().lattice;
  if (features.wraps() || features.mask() || lattice.is_single_cell(size)) return out;
  const Planes planes = view_of(weighted_planes(features, task), {}, whole(size)).planes;
  if (std::min(planes.size.width, planes.size.height) < border_strips * least_pixels) return out;
  const std::vector<Tone> parts = tones_of_parts(planes);
  const std::vector<Tone> rows = tones_of_strips(parts, true), columns = tones_of_strips(parts, false);
  const bool in_courses = lattice.rank == 1 && lattice.first.x() == 0;
  const bool in_columns = lattice.rank == 1 && !in_courses;
  const auto pixels = [](int count, int side) { return int(int64_t{count} * side / border_strips); };
  if (lattice.rank < 2 && !in_columns) {
    const UnevenBorders b = uneven_borders(columns);
    out.part.x = pixels(b.first, size.width);
    out.part.width -= out.part.x + pixels(b.last, size.width);
  }
  if (lattice.rank < 2 && !in_courses) {
    const UnevenBorders b = uneven_borders(rows);
    out.part.y = pixels(b.first, size.height);
    out.part.height -= out.part.y + pixels(b.last, size.height);
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
