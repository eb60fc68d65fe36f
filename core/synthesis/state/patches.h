#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/synthesis/state/candidate_votes.h"
#include "core/synthesis/state/expansion.h"
#include "core/synthesis/state/usage_penalty.h"

namespace terrazzo {

/// Windows of 13x13 pixels, named by their middles, and what of the exemplar might cover them (patch fitting: Kwatra et
/// al., Graphcut textures, 2003). Not thread-safe; several may work at the same time, as for_each_window() has them.
class Patches {
 public:
  static constexpr int half = 6;   ///< of a window, without its middle
  static constexpr int core = 4;   ///< the same without the rim
  static constexpr int near = 20;  ///< what shows so near the middle already is not shown again
  /// From this level on there are so many pixels that not all windows are worth the time.
  static constexpr int many_pixels = 1;

  /// `usage`: what is in use too often fits less well.
  Patches(ExpansionGround& ground, const UsagePenalty& usage, uint64_t seed);

  /// The places whose surroundings fit a window's rim best, at most so many, the best first. They are those that the
  /// rim, its similar pixels and chance suggest; none is in the core's surroundings already, or out of phase.
  const std::vector<uint32_t>& fitting(int x, int y, size_t most);
  /// Offers a window one of those places: a minimum cut takes as much of it as lowers the mismatch.
  void lay(int x, int y, uint32_t place);

 private:
  struct Offset {
    int x;
    int y;
  };
  static std::vector<Offset> scattered_rim();
  int64_t index(int x, int y) const;
  ExemplarPixel pixel(int x, int y) const { return ground_.field.pixels[size_t(index(x, y))]; }
  void collect_places(int x, int y);
  void add_place(int x, int y, int u, int v);
  int64_t misfit_at(uint32_t place, int64_t limit) const;
  bool shows_near(int x, int y, uint32_t place) const;

  ExpansionGround& ground_;
  const UsagePenalty& usage_;
  uint64_t seed_;
  std::vector<Offset> rim_;
  std::vector<const AppearanceVector*> shown_;  // by the rim
  CandidateVotes places_;
  std::vector<int64_t> misfits_;  // of the places that fit
  std::vector<uint32_t> fitting_;
  Expansion expansion_;
};

/// The sums of the values of every pixel's core; 0 where the window does not lie in the field.
std::vector<int32_t> core_sums(const std::vector<int32_t>& values, Size size, const PlaneWindow& window);
/// The middles of windows whose sum is above that, the largest first. No window's middle lies in another's core.
std::vector<int> worst_first(const std::vector<int32_t>& sums, int64_t least, Size size);
/// Works on windows one after the other, as far as they lie near one another, and otherwise at the same time. Throws
/// Cancelled.
void for_each_window(std::span<const int> windows, const Field& field, const PlaneWindow& part, const Task& task,
                     const std::function<void(int x, int y)>& work);

}  // namespace terrazzo
