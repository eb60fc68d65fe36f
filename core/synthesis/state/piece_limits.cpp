#include "core/synthesis/state/piece_limits.h"

#include <algorithm>

#include "core/base/tuning.h"
#include "core/synthesis/state/cost_factor.h"
#include "core/synthesis/state/pieces.h"

namespace terrazzo {

namespace {

struct PieceLimitsTuning {
  double large = 0.119;
  double fragment = 0.3;
  double large_on_lattice = 0.055;
  double fragment_on_lattice = 0.1;
};
const Tunable<PieceLimitsTuning> piece_limits_tuning(
    "piece_limits",
    {
        {&PieceLimitsTuning::large, "large", "share of the exemplar's area",
         "higher: larger pieces, fewer seams, less broken; lower: less is copied verbatim", "piece_limits"},
        {&PieceLimitsTuning::fragment, "fragment", "share of large",
         "higher: more small pieces give way to their neighbours; lower: small pieces stay and more seams with them",
         "piece_limits"},
        {&PieceLimitsTuning::large_on_lattice, "large_on_lattice", "share of the exemplar's area",
         "the same with a lattice, where less is out of phase and pieces grow more readily", "piece_limits"},
        {&PieceLimitsTuning::fragment_on_lattice, "fragment_on_lattice", "share of large_on_lattice",
         "the same with a lattice", "piece_limits"},
    });

}  // namespace

PieceLimits PieceLimits::of(bool regular) {
  return regular ? PieceLimits{piece_limits_tuning->large_on_lattice, piece_limits_tuning->fragment_on_lattice}
                 : PieceLimits{piece_limits_tuning->large, piece_limits_tuning->fragment};
}

std::vector<uint32_t> piece_coherence(const Field& field, const CorrectionLevel& level, double coherence,
                                      const PieceLimits& limits) {
  const Pieces pieces(field, level);
  const double large = limits.large * double(level.exemplar.size().area());
  std::vector<uint32_t> factors(field.pixels.size());
  for (int piece = 0; piece < pieces.count(); piece++) {
    const double size = pieces.area(piece) / large;
    const double penalty = size < limits.fragment ? 2 - size / limits.fragment : std::max(1.0, size);
    const auto factor = uint32_t(coherence * penalty * unit_factor);
    for (const int i : pieces.members(piece)) factors[size_t(i)] = factor;
  }
  return factors;
}

}  // namespace terrazzo
