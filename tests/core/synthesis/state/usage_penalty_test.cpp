#include "core/synthesis/state/usage_penalty.h"

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

constexpr Size exemplar{32, 32};  // cells of 2x2 pixels

/// An output whose pixel (x, y) shows exemplar pixel (x % width, y % height).
Field showing(Size output, int width, int height) {
  Field field{output, {}};
  for (int y = 0; y < output.height; y++)
    for (int x = 0; x < output.width; x++) field.pixels.push_back({uint16_t(x % width), uint16_t(y % height)});
  return field;
}

}  // namespace

TEST_CASE("even use costs nothing, what is used too much is dear and what is used too little cheap, down to a limit") {
  UsagePenalty even(exemplar, 1, 0.75), uneven(exemplar, 1, 0.75);
  even.recount(showing({64, 64}, 32, 32), {});
  CHECK(even.factor(0, 0) == unit_factor);
  CHECK(even.factor(31, 31) == unit_factor);
  uneven.recount(showing({64, 64}, 16, 32), {});
  CHECK(uneven.factor(0, 0) == 2 * unit_factor);
  CHECK(uneven.factor(31, 31) == unit_factor * 3 / 4);
}

TEST_CASE(
    "under integral control what stays unevenly used gets dearer and cheaper with every count, and never for nothing") {
  UsagePenalty controlled(exemplar, 0.7, 0.5), content(exemplar, 0.7, 0.5);
  controlled.enable_integral_control();
  content.enable_integral_control();
  uint32_t dearest = unit_factor, cheapest = unit_factor;
  for (int count = 0; count < 2; count++) {
    controlled.recount(showing({64, 64}, 16, 32), {});
    CHECK(controlled.factor(0, 0) > dearest);
    CHECK(controlled.factor(31, 31) < cheapest);
    dearest = controlled.factor(0, 0);
    cheapest = controlled.factor(31, 31);
  }
  for (int count = 0; count < 100; count++) controlled.recount(showing({64, 64}, 16, 32), {});
  CHECK(controlled.factor(31, 31) >= unit_factor / 4);
  CHECK(controlled.factor(0, 0) <= 8 * unit_factor);
  for (int count = 0; count < 100; count++) content.recount(showing({64, 64}, 32, 32), {});
  CHECK(content.factor(0, 0) == unit_factor);
}

TEST_CASE("a small output may show one piece of the exemplar once") {
  UsagePenalty small(exemplar, 1, 0);
  small.recount(showing({8, 8}, 8, 8), {});
  CHECK(small.factor(0, 0) == unit_factor);
  CHECK(small.factor(31, 31) > unit_factor * 9 / 10);
  small.recount(showing({8, 8}, 4, 8), {});
  CHECK(small.factor(0, 0) == 2 * unit_factor);
}

TEST_CASE("of what is seldom wanted one piece may be shown once, and no more") {
  std::vector<double> demand(size_t(exemplar.area()), 1.0);
  for (int y = 0; y < exemplar.height; y++)
    for (int x = 16; x < exemplar.width; x++) demand[size_t(y) * exemplar.width + x] = 0.1;
  Field field = showing({32, 32}, 16, 32);
  for (int y = 0; y < 8; y++)
    for (int x = 0; x < 8; x++) field.at(x, y) = {uint16_t(16 + x), uint16_t(y)};
  UsagePenalty once(exemplar, 1, 0.5, demand), twice(exemplar, 1, 0.5, demand);
  once.recount(field, {});
  CHECK(once.factor(16, 0) == unit_factor);
  for (int y = 8; y < 16; y++)
    for (int x = 0; x < 8; x++) field.at(x, y) = {uint16_t(16 + x), uint16_t(y - 8)};
  twice.recount(field, {});
  CHECK(twice.factor(16, 0) > unit_factor * 3 / 2);
}
