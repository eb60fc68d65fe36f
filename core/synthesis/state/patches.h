#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/synthesis/state/candidate_votes.h"
#include "core/synthesis/state/expansion.h"
#include "core/synthesis/state/usage_penalty.h"

namespace terrazzo {

/// Windows of 13x13 pixels, named by their middles, and the exemplar's patches that might cover them (patch fitting:
/// Kwatra et al., Graphcut textures, 2003). Not thread-safe; for_each_window() lets several work at the same time.
class Patches {
 public:
  static constexpr int half = 6;  ///< a window's pixels to each side of its middle
  static constexpr int core = 4;  ///< the same without the rim, which is compared
  /// What shows up to so many pixels from the middle already is not offered; greater than `half`.
  static int near();

  /// `usage`: over-used patches fit less well.
  Patches(ExpansionProblem& problem, const UsagePenalty& usage, uint64_t seed);

  /// The place whose patch fits a window's rim best; none if there is no candidate. Candidates come from the rim's
  /// pixels, their k-coherent candidates and chance; none shows near by already or is out of phase.
  std::optional<uint32_t> best(int x, int y);
  /// Offers a window that place: a minimum cut takes as much of it as lowers the mismatch.
  void lay(int x, int y, uint32_t place);

 private:
  struct Offset {
    int x;
    int y;
  };
  static std::vector<Offset> scattered_rim();
  int64_t index(int x, int y) const;
  ExemplarPixel pixel(int x, int y) const { return problem_.field.pixels[size_t(index(x, y))]; }
  void collect_places(int x, int y);
  void add_place(int x, int y, int u, int v);
  int64_t misfit_at(uint32_t place, int64_t limit) const;
  bool shows_near(int x, int y, uint32_t place) const;

  ExpansionProblem& problem_;
  const UsagePenalty& usage_;
  uint64_t seed_;
  std::vector<Offset> rim_;
  std::vector<const AppearanceVector*> shown_;  // what the rim shows
  CandidateVotes places_;
  Expansion expansion_;
};

/// The sum of values over the core around every pixel; 0 where the window does not lie within the field.
std::vector<int32_t> core_sums(const std::vector<int32_t>& values, Size size, const PlaneWindow& window);
/// The middles of windows whose sum is above `least`, the largest first. No window's middle lies in another's core.
std::vector<int> worst_first(const std::vector<int32_t>& sums, int64_t least, Size size);
/// Works on windows in that order; those that lie far enough apart at the same time. Throws Cancelled.
void for_each_window(std::span<const int> windows, const Field& field, const PlaneWindow& part, const Task& task,
                     const std::function<void(int x, int y)>& work);

}  // namespace terrazzo
