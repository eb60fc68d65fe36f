#include "core/synthesis/state/candidate_votes.h"

#include <doctest/doctest.h>

using namespace terrazzo;

TEST_CASE("what is suggested most often comes first, each once, and of those alike the lower") {
  CandidateVotes s;
  for (int round = 0; round < 2; round++) {
    s.clear();
    for (const uint32_t what : {7u, 9u, 3u, 9u, 0xffffffffu, 7u, 9u}) s.add(what);
    std::vector<uint32_t> order;
    for (const auto& [what, votes] : s.by_votes()) order.push_back(what);
    CHECK(order == std::vector<uint32_t>{9, 7, 3, 0xffffffffu});
    CHECK(s.by_votes().front().votes == 3);
  }
}
