#include "core/synthesis/state/random_order.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

const std::vector<double> lengths = {25, 18, 42, 15};

std::vector<int> counts(const std::vector<int>& order) {
  std::vector<int> out(lengths.size(), 0);
  for (const int k : order) out[size_t(k)]++;
  return out;
}

int twice_in_a_row(const std::vector<int>& order, bool around) {
  int out = around && order.front() == order.back();
  for (size_t i = 1; i < order.size(); i++) out += order[i] == order[i - 1];
  return out;
}

}  // namespace

TEST_CASE("an endless order shows all as often, none twice in a row, and not the same round again and again") {
  for (const uint64_t bits : {1, 2, 3, 4}) {
    RandomOrder random(lengths, bits);
    const std::vector<int> order = random.endless(2000, 2);
    CHECK(order.front() != 2);
    CHECK(random.length_of(order) >= 2000);
    CHECK(random.length_of(order) < 2000 + 42);
    CHECK(twice_in_a_row(order, false) == 0);
    const auto [least, most] = std::ranges::minmax(counts(order));
    CHECK(most - least <= 2);
    CHECK(!std::equal(order.begin() + 4, order.begin() + 40, order.begin() + 8));
  }
  CHECK(RandomOrder(lengths, 1).endless(300) != RandomOrder(lengths, 2).endless(300));
  CHECK(RandomOrder(lengths, 1).endless(0).empty());
}

TEST_CASE("a length is filled by what makes it up, evenly") {
  for (const double length : {100.0, 150.0, 185.0, 240.0, 1000.0, 1203.0, 4321.0})
    for (const uint64_t bits : {1, 2, 3}) {
      RandomOrder random(lengths, bits);
      const std::vector<int> order = random.filling(length);
      CHECK(std::abs(random.length_of(order) - length) <= std::max(2.0, 0.02 * length));
      CHECK(twice_in_a_row(order, true) == 0);
      const auto [least, most] = std::ranges::minmax(counts(order));
      CHECK(most - least <= 2);
    }
}

TEST_CASE("between two others a gap is filled by neither next to itself") {
  for (const uint64_t bits : {1, 2, 3, 4, 5, 6, 7, 8}) {
    const std::vector<int> order = RandomOrder(lengths, bits).filling(200, {0, 1});
    CHECK(order.front() != 0);
    CHECK(order.back() != 1);
  }
}

TEST_CASE("of pieces of one length all come into gaps that hold few of them") {
  RandomOrder random(std::vector<double>(12, 20.0), 7);
  std::vector<int> used(12, 0);
  for (int i = 0; i < 60; i++)
    for (const int k : random.filling(80)) used[size_t(k)]++;
  CHECK(std::ranges::min(used) >= 8);  // of twenty in the mean
}

TEST_CASE("what is too short for any is left, and one alone comes again and again") {
  CHECK(RandomOrder(lengths, 1).filling(5, {0, 1}).empty());
  CHECK(RandomOrder(lengths, 1).filling(-3, {0, 1}).empty());
  CHECK(RandomOrder({20}, 1).filling(61) == std::vector{0, 0, 0});
  CHECK(RandomOrder({20}, 1).endless(50) == std::vector{0, 0, 0});
}
