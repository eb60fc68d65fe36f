#include "core/synthesis/state/random_order.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/hash.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

namespace {

int total(const std::vector<int>& counts) {
  return std::accumulate(counts.begin(), counts.end(), 0);
}

}  // namespace

RandomOrder::RandomOrder(std::vector<double> lengths, uint64_t bits)
    : lengths_(std::move(lengths)), all_(std::accumulate(lengths_.begin(), lengths_.end(), 0.0)), bits_(bits) {}

double RandomOrder::draw() {
  return unit_double(more_random_bits(bits_, drawn_++));
}

double RandomOrder::length_of(const std::vector<int>& pieces) const {
  return std::accumulate(pieces.begin(), pieces.end(), 0.0,
                         [&](double sum, int k) { return sum + lengths_[size_t(k)]; });
}

std::vector<int> RandomOrder::endless(double length, int before) {
  if (length <= 0) return {};
  std::vector<int> out = shuffled(std::vector<int>(lengths_.size(), int(length / all_) + 1), {before, -1});
  double so_far = 0;
  const auto last = std::ranges::find_if(out, [&](int k) { return (so_far += lengths_[size_t(k)]) >= length; });
  if (last != out.end()) out.erase(last + 1, out.end());
  return out;
}

std::vector<int> RandomOrder::filling(double length, const SequenceEnds& ends) {
  return length <= 0 ? std::vector<int>() : shuffled(counts_for(length), ends);
}

/// How often each comes for all to make up a length: one that is shown once more, or once less, than it should counts
/// like missing as much as is not seen. The subset sum problem (Bellman 1957), each piece up to three times beside
/// whole rounds of all. Of choices that are as good any is taken: pieces count in random order.
std::vector<int> RandomOrder::counts_for(double length) {
  constexpr int most = 3, unknown = std::numeric_limits<int>::max();
  const int rounds = std::max(0, int(length / all_) - 1), left = int(std::lround(length - rounds * all_));
  const double unseen = std::max(1.0, Lattice{1, {}, {}, 1}.unseen_bend() * length);
  const auto sums = size_t(left + int(std::ranges::max(lengths_)) + 1);
  // Of each sum of the pieces so far: how uneven their counts are at least, and the last one's count then.
  std::vector<int> least(sums, unknown);
  least[0] = 0;
  std::vector<std::vector<uint8_t>> counts;
  std::vector<size_t> pieces(lengths_.size());
  std::iota(pieces.begin(), pieces.end(), size_t{0});
  const uint64_t bits = more_random_bits(bits_, filled_++);
  for (size_t k = pieces.size(); k > 1; k--)
    std::swap(pieces[k - 1], pieces[below(uint32_t(more_random_bits(bits, k)), uint32_t(k))]);
  for (const size_t k : pieces) {
    const double piece = lengths_[k];
    std::vector<int> next(sums, unknown);
    std::vector<uint8_t> chosen(sums, 0);
    for (int n = 0; n <= most; n++)
      for (size_t at = size_t(n * std::lround(piece)), from = 0; at < sums; at++, from++) {
        if (least[from] == unknown) continue;
        const int uneven = least[from] + (n - 1) * (n - 1);
        if (uneven < next[at]) chosen[at] = uint8_t(n);
        next[at] = std::min(next[at], uneven);
      }
    least = std::move(next);
    counts.push_back(std::move(chosen));
  }
  const auto badness = [&](size_t sum) {
    return least[sum] == unknown ? std::numeric_limits<double>::infinity()
                                 : least[sum] + std::abs(double(sum) - left) / unseen;
  };
  size_t best = 0;
  for (size_t sum = 1; sum < sums; sum++)
    if (badness(sum) < badness(best)) best = sum;
  std::vector<int> out(lengths_.size(), rounds);
  for (size_t i = out.size(); i-- > 0;) {
    const size_t k = pieces[i];
    out[k] += counts[i][best];
    best -= size_t(counts[i][best] * std::lround(lengths_[k]));
  }
  return out;
}

/// Always one of those that are left most often, but for the one just taken.
std::vector<int> RandomOrder::shuffled(std::vector<int> counts, const SequenceEnds& ends) {
  std::vector<int> out;
  for (int left = total(counts); left > 0; left--) {
    const int last = out.empty() ? ends.before : out.back();
    int most = 0;
    std::vector<int> best;
    for (int k = 0; k < int(counts.size()); k++) {
      if (k == last && left > counts[size_t(k)]) continue;
      if (counts[size_t(k)] > most) best.clear();
      most = std::max(most, counts[size_t(k)]);
      if (most > 0 && counts[size_t(k)] == most) best.push_back(k);
    }
    out.push_back(best[size_t(draw() * double(best.size()))]);
    counts[size_t(out.back())]--;
  }
  // Of the same two at the end the last changes places with another that may stand beside them.
  const bool around = ends.after < 0;
  const size_t n = out.size();
  const int next = around && n > 0 ? out.front() : ends.after;
  for (size_t i = around ? 1 : 0; i + 1 < n && out.back() == next; i++) {
    const int previous = i > 0 ? out[i - 1] : ends.before;
    if (out[i] != next && previous != next && out[i + 1] != next && (i + 2 == n || out[n - 2] != out[i]))
      std::swap(out[i], out.back());
  }
  return out;
}

}  // namespace terrazzo
