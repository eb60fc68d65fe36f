#pragma once

#include <cstdint>
#include <vector>

namespace terrazzo {

/// What stands before and after a sequence: numbers of pieces, or -1.
struct SequenceEnds {
  int before = -1, after = -1;
};

/// Pieces of these lengths in random order, each about as often as the others and none twice in a row where that can be
/// helped. Thread-safe.
class RandomOrder {
 public:
  /// `lengths`: of the pieces, in pixels, at least one, each 1 or more.
  RandomOrder(std::vector<double> lengths, uint64_t bits);

  /// At least so long together.
  std::vector<int> endless(double length, int before = -1);
  /// About so long together, and each about as often as the others. Without `ends` the first one follows on the last.
  /// Empty if that is nearest.
  std::vector<int> filling(double length, const SequenceEnds& ends = {});
  double length_of(const std::vector<int>& pieces) const;
  /// A random number of 0..1, 1 excluded.
  double draw();

 private:
  std::vector<int> counts_for(double length);
  std::vector<int> shuffled(std::vector<int> counts, const SequenceEnds& ends);

  std::vector<double> lengths_;
  double all_;
  uint64_t bits_, drawn_ = 0, filled_ = 0;
};

}  // namespace terrazzo
