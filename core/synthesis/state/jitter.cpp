#include "core/synthesis/state/jitter.h"

#include "core/base/portable_math.h"

namespace terrazzo {

std::vector<double> jitter_amplitudes(const JitterSpec& spec, const Appearance& appearance) {
  using Shape = JitterSpec::Shape;
  const std::vector<double>& given = spec.amplitudes;
  std::vector<double> out(appearance.levels().size(), 0.0);
  if (given.empty()) return out;
  for (size_t i = 0; i < out.size(); i++) {
    const double from_peak = double(i) - spec.peak;
    const bool beyond =
        (spec.shape == Shape::rising && from_peak > 0) || (spec.shape == Shape::falling && from_peak < 0);
    if (spec.shape == Shape::constant || given.size() == 1)
      out[i] = given[0];
    else if (i < given.size())
      out[i] = given[i];
    if (spec.shape < Shape::peak) continue;
    const double deviations = from_peak / spec.spread;
    out[i] = beyond ? 0 : given[0] * portable::exp(-0.5 * deviations * deviations);
  }
  return out;
}

}  // namespace terrazzo
