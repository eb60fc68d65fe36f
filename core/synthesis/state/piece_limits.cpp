#include "core/synthesis/state/piece_limits.h"

#include <algorithm>

#include "core/synthesis/state/pieces.h"
#include "core/synthesis/state/usage_penalty.h"

namespace terrazzo {

namespace {

constexpr PieceLimits irregular_pieces{0.119, 0.3};
// With a lattice less is out of phase, so pieces grow more readily.
constexpr PieceLimits pieces_on_lattice{0.055, 0.1};
constexpr double most_coherence = 3;

}  // namespace

PieceLimits PieceLimits::of(bool regular) {
  return regular ? pieces_on_lattice : irregular_pieces;
}

std::vector<uint32_t> piece_coherence(const Field& field, const CorrectionLevel& level, double coherence,
                                      const PieceLimits& limits) {
  const Pieces pieces(field, 1, level.window.closed_x, level.window.closed_y);
  const double fair = limits.large * double(level.exemplar.size().area());
  std::vector<uint32_t> factors(field.pixels.size());
  for (size_t i = 0; i < factors.size(); i++) {
    const double size = pieces.area(pieces.of(int(i))) / fair;
    const double dearness = size < limits.fragment ? 2 - size / limits.fragment : std::max(1.0, size);
    factors[i] = uint32_t(std::min(most_coherence, coherence * dearness) * unit_factor);
  }
  return factors;
}

}  // namespace terrazzo
