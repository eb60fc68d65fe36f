#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace terrazzo {

/// Candidates packed into 32 bits, as they are proposed: the same one may come several times.
class CandidateVotes {
 public:
  struct Candidate {
    uint32_t what;
    int votes;
  };

  void clear() { all_.clear(); }
  void add(uint32_t what) { all_.push_back(what); }

  /// Each candidate once, the most proposed first: those fit best more often than not, so that the others are rejected
  /// early.
  const std::vector<Candidate>& by_votes() {
    std::sort(all_.begin(), all_.end());
    voted_.clear();
    for (const uint32_t what : all_) {
      if (voted_.empty() || voted_.back().what != what) voted_.push_back({what, 0});
      voted_.back().votes++;
    }
    std::stable_sort(voted_.begin(), voted_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.votes > b.votes; });
    return voted_;
  }

 private:
  std::vector<uint32_t> all_;
  std::vector<Candidate> voted_;
};

}  // namespace terrazzo
