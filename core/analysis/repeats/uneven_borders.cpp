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
};
const Tunable<UnevenBordersTuning> uneven_borders_tuning(
    "uneven_borders",
    {{&UnevenBordersTuning::least, "least", "deviations of the strips inside",
      "by which the outermost strip must differ. Higher: dark borders come in patches; lower: grounds that change "
      "slowly lose some of what they show",
      "uneven_borders"},
     {&UnevenBordersTuning::inwards, "inwards", "deviations of the strips inside",
      "by which those must differ that are left out with it. Higher: what fades out stays; lower: more is left out",
      "uneven_borders"}});

constexpr int border_strips = 16;               ///< from border to border
constexpr int most_strips = border_strips / 4;  ///< of a border; those farther inside are compared with
constexpr int least_strips = 2;                 ///< one alone may be a joint, or chance
constexpr int least_pixels = 4;                 ///< of a strip's breadth
constexpr double flat = 0.1;                    ///< deviations of the whole exemplar: smaller differences do not show

using Tone = std::vector<double>;  // a mean per channel

/// The mean tones of strips along rows (or columns), from the first border to the other.
std::vector<Tone> tones_of_strips(const Planes& planes, bool rows) {
  std::vector<Tone> out(size_t(border_strips), Tone(size_t(planes.channels), 0.0));
  std::vector<int64_t> pixels(size_t(border_strips), 0);
  const Size size = planes.size;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const auto strip =
          size_t(rows ? int64_t{y} * border_strips / size.height : int64_t{x} * border_strips / size.width);
      const float* value = planes.at(x, y);
      for (int c = 0; c < planes.channels; c++) out[strip][size_t(c)] += double(value[c]);
      pixels[strip]++;
    }
  for (size_t i = 0; i < out.size(); i++)
    for (double& v : out[i]) v /= double(pixels[i]);
  return out;
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

UnevenBorders uneven_borders(const Planes& planes, bool rows) {
  std::vector<Tone> tones = tones_of_strips(planes, rows);
  const Inside inside = inside_of(tones);
  const int first = count_uneven(tones, inside);
  std::reverse(tones.begin(), tones.end());
  return {first, count_uneven(tones, inside)};
}

}  // namespace

Rect even_part(const Features& features, const Task& task) {
  const Size size = features.size();
  const Lattice& bands = features.repeats().lattice;
  Rect out = whole(size);
  if (features.wraps() || features.mask() || bands.rank > 1) return out;
  const Planes planes = view_of(weighted_planes(features, task), {}, out).planes;
  if (std::min(planes.size.width, planes.size.height) < border_strips * least_pixels) return out;
  const auto pixels = [](int count, int side) { return int(int64_t{count} * side / border_strips); };
  if (bands.rank == 0 || bands.first.x() == 0) {
    const UnevenBorders b = uneven_borders(planes, false);
    out.x = pixels(b.first, size.width);
    out.width -= out.x + pixels(b.last, size.width);
  }
  if (bands.rank == 0 || bands.first.x() != 0) {
    const UnevenBorders b = uneven_borders(planes, true);
    out.y = pixels(b.first, size.height);
    out.height -= out.y + pixels(b.last, size.height);
  }
  return out;
}

}  // namespace terrazzo
