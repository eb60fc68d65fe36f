#include "core/synthesis/steps/course_sequence.h"

#include <algorithm>
#include <map>

#include <doctest/doctest.h>

using namespace terrazzo;

TEST_CASE("all that lies between joints comes as often, whole, and none twice in a row") {
  const std::vector<int> joints = {5, 30, 48, 90};  // the last goes on around the border to 105
  const int around = 100;
  const auto part_of = [&](int u) {
    const auto after = std::ranges::upper_bound(joints, u);
    return int(after - joints.begin() + 3) % 4;
  };
  for (const uint64_t bits : {1, 2, 3, 4}) {
    const std::vector<int> shown = random_sequence(joints, around, 2000, 1, bits);
    REQUIRE(shown.size() == 2000);
    std::map<int, int> columns;
    std::vector<int> order;
    for (size_t x = 0; x < shown.size(); x++) {
      columns[shown[x]]++;
      const bool goes_on = x > 0 && shown[x] == (shown[x - 1] + 1) % around;
      if (x > 0 && !goes_on) CHECK(std::ranges::find(joints, shown[x]) != joints.end());
      if (x == 0 || part_of(shown[x]) != part_of(shown[x - 1])) order.push_back(part_of(shown[x]));
      if (x > 0 && !goes_on) CHECK(part_of(shown[x]) != part_of(shown[x - 1]));
    }
    CHECK(columns.size() == 100);
    int least = 2000, most = 0;
    for (const auto& [column, times] : columns) least = std::min(least, times), most = std::max(most, times);
    CHECK(most - least <= 2);
    // Not the same order again and again.
    CHECK(!std::equal(order.begin() + 4, order.begin() + 40, order.begin() + 8));
  }
  CHECK(random_sequence(joints, around, 60, 1, 1) != random_sequence(joints, around, 60, 1, 2));
}

TEST_CASE("of a single joint the course goes on around the exemplar; of two its parts take turns") {
  const std::vector<int> one = random_sequence({7}, 20, 50, 1, 3);
  for (size_t x = 1; x < one.size(); x++) CHECK(one[x] == (one[x - 1] + 1) % 20);
  const std::vector<int> two = random_sequence({0, 10}, 20, 80, 2, 3);
  REQUIRE(two.size() == 80);
  for (size_t x = 1; x < two.size(); x++) CHECK((two[x] == (two[x - 1] + 2) % 20 || two[x] % 10 == 0));
}
