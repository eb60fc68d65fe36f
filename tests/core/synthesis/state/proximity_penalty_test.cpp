#include "core/synthesis/state/proximity_penalty.h"

#include <doctest/doctest.h>

#include "core/synthesis/state/usage_penalty.h"

using namespace terrazzo;

namespace {

constexpr Size exemplar{32, 32};  // cells of 2x2 pixels, blocks of 4x4
/// Made when it is asked for: tuning constants are not there before main.
const ExemplarCells& cells() {
  static const ExemplarCells all(exemplar);
  return all;
}

/// A plane that shows exemplar pixel (0, 0) everywhere but for 8x8 pixels from (16, 16) on at each of the places.
Field with_copies(Size size, std::initializer_list<std::array<int, 2>> places) {
  Field field{size, std::vector<ExemplarPixel>(size_t(size.area()), ExemplarPixel{0, 0})};
  for (const auto& [left, top] : places)
    for (int y = 0; y < 8; y++)
      for (int x = 0; x < 8; x++) field.at(left + x, top + y) = {uint16_t(16 + x), uint16_t(16 + y)};
  return field;
}

/// What it costs to show the middle of what was copied at a position.
uint32_t factor_at(int x, int y, const Field& field, bool tiles = false) {
  ProximityPenalty use(exemplar, std::vector<double>(cells().count, 4.0), 0.7, {field.size, tiles, tiles});
  use.count(field, cells());
  return use.factors(x, y)[cells().of(20, 20)];
}

}  // namespace

TEST_CASE("what shows near by once costs no more than elsewhere, twice is dear, and dearer the nearer") {
  const Size size{128, 64};
  CHECK(factor_at(24, 24, with_copies(size, {{20, 20}})) == unit_factor);
  const uint32_t near = factor_at(24, 24, with_copies(size, {{20, 20}, {28, 20}}));
  const uint32_t farther = factor_at(24, 24, with_copies(size, {{20, 20}, {32, 20}}));
  CHECK(near > farther);
  CHECK(farther > unit_factor * 3 / 2);
  CHECK(factor_at(24, 24, with_copies(size, {{20, 20}, {60, 20}})) == unit_factor);
}

TEST_CASE("what is dear near its copies is not dear elsewhere") {
  const Field field = with_copies({128, 64}, {{20, 20}, {28, 20}});
  CHECK(factor_at(100, 24, field) == unit_factor);
}

TEST_CASE("a plane that tiles looks around its borders") {
  const Field field = with_copies({128, 64}, {{2, 2}, {118, 54}});
  CHECK(factor_at(4, 4, field) == unit_factor);
  CHECK(factor_at(4, 4, field, true) > unit_factor * 3 / 2);
  CHECK(factor_at(124, 60, field, true) > unit_factor * 3 / 2);
}

TEST_CASE("a small plane that tiles counts nothing twice") {
  CHECK(factor_at(9, 9, with_copies({16, 16}, {{4, 4}}), true) == unit_factor);
  CHECK(factor_at(9, 9, with_copies({16, 16}, {{0, 4}, {8, 4}}), true) > unit_factor * 3 / 2);
}

TEST_CASE("an exemplar of a few pixels may come about as often as it must") {
  const Size tiny{4, 4};
  const ExemplarCells few(tiny);
  ProximityPenalty use(tiny, std::vector<double>(few.count, 4.0), 0.7, {{32, 32}});
  Field field{{32, 32}, {}};
  for (int i = 0; i < 32 * 32; i++) field.pixels.push_back({uint16_t(i % 4), uint16_t(i / 32 % 4)});
  use.count(field, few);
  for (size_t cell = 0; cell < few.count; cell++) CHECK(use.factors(16, 16)[cell] < 2 * unit_factor);
}

TEST_CASE("what is near is counted unless that took too much memory") {
  CHECK(ProximityPenalty::is_worth_it({128, 128}, ExemplarCells({128, 128}), {{2048, 2048}}));
  CHECK_FALSE(ProximityPenalty::is_worth_it({16, 16}, ExemplarCells({16, 16}), {{4096, 4096}}));
}

TEST_CASE("usage counts what shows near by from when it is told to until its counts are frozen") {
  UsagePenalty usage(exemplar, 0.7, 0.5), even(exemplar, 0, 0.5);
  CHECK(usage.nearby_factors(24, 24) == nullptr);
  const Field field = with_copies({128, 64}, {{20, 20}, {28, 20}});
  usage.enable_proximity_penalty({field.size});
  usage.recount(field, {});
  REQUIRE(usage.nearby_factors(24, 24));
  CHECK(usage.nearby_factors(24, 24)[usage.cell(20, 20)] > unit_factor * 3 / 2);
  usage.freeze_counts(field.pixels, {});
  CHECK(usage.nearby_factors(24, 24) == nullptr);
  even.enable_proximity_penalty({field.size});
  CHECK(even.nearby_factors(24, 24) == nullptr);
}
