#include "core/analysis/repeats/near_peaks.h"

#include <algorithm>
#include <tuple>

#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct NearPeaksTuning {
  double strong = 0.5;
  int most_peaks = 44;
  int strongest = 5;
};
const Tunable<NearPeaksTuning> near_peaks_tuning(
    "near_peaks",
    {
        {&NearPeaksTuning::strong, "strong", "share of a strong peak",
         "what others must reach. Higher: less time; lower: cells whose peaks are faint are tried",
         "What each rule decides"},
        {&NearPeaksTuning::most_peaks, "most_peaks", "peaks",
         "the nearest, of which all pairs are tried. Higher: cells are not missed; costs time, with its square",
         "What each rule decides"},
        {&NearPeaksTuning::strongest, "strongest", "peaks",
         "that may be chance: the next says what is strong. Higher: more peaks are tried; lower: few may decide",
         "What each rule decides"},
    });

}  // namespace

std::vector<Vector2d> near_peaks(const Correlation& r) {
  struct Peak {
    Vector2d at;
    double value;
  };
  std::vector<Peak> peaks;
  const double shortest = shortest_repeat();
  for (int y = 0; y < r.lags().height - 3; y++)
    for (int x = y == 0 ? 1 : 4 - r.lags().width; x < r.lags().width - 3; x++) {
      if (x * x + y * y < shortest * shortest || !r.covers(x, y)) continue;
      const double v = r.at(x, y);
      bool highest = v > 0;
      for (int j = -2; j <= 2 && highest; j++)
        for (int i = -2; i <= 2 && highest; i++) highest = r.at(x + i, y + j) <= v;
      if (!highest) continue;
      const auto [at, value] = r.peak_near({double(x), double(y)});
      peaks.push_back({at, value});
    }
  if (peaks.empty()) return {};
  const size_t rank = std::min(size_t(near_peaks_tuning->strongest), peaks.size() - 1);
  std::nth_element(peaks.begin(), peaks.begin() + ptrdiff_t(rank), peaks.end(),
                   [](const Peak& a, const Peak& b) { return a.value > b.value; });
  const double least = near_peaks_tuning->strong * peaks[rank].value;
  std::vector<Vector2d> out;
  for (const Peak& p : peaks)
    if (p.value >= least) out.push_back(p.at);
  const auto nearness = [](const Vector2d& v) { return std::tuple(v.squaredNorm(), v.y(), v.x()); };
  std::ranges::sort(out, {}, nearness);
  out.resize(std::min(out.size(), size_t(near_peaks_tuning->most_peaks)));
  return out;
}

}  // namespace terrazzo
