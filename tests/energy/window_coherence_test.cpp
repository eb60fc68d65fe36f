#include "tests/energy/window_coherence.h"

#include <doctest/doctest.h>

#include "tests/core/synthesis/slopes.h"

using namespace terrazzo;

namespace {

constexpr Size size{64, 60};

/// Its left part goes on from one place, the three columns on the right from another.
WindowCoherence::Window window(ExemplarPixel left, ExemplarPixel right) {
  WindowCoherence::Window out;
  for (int i = 0; i < WindowCoherence::side * WindowCoherence::side; i++) {
    const int x = i % WindowCoherence::side, y = i / WindowCoherence::side;
    const ExemplarPixel& from = x < 4 ? left : right;
    out[i] = {uint16_t(from.x + x), uint16_t(from.y + y)};
  }
  return out;
}

CorrectionLevel level_of(const PaddedLevel& exemplar, const std::vector<ExemplarPixel>& similar, int per_pixel = 0) {
  return {.exemplar = exemplar,
          .similar = similar,
          .per_pixel = per_pixel,
          .level = 2,
          .window = PlaneWindow::all_of({size, false, false}),
          .phase = {},
          .fixed = {}};
}

}  // namespace

TEST_CASE("what the exemplar shows is like it, and so is what differs as little as its own windows do") {
  const PaddedLevel exemplar = test::slopes(size);
  const std::vector<ExemplarPixel> none;
  const CorrectionLevel level = level_of(exemplar, none);
  const WindowCoherence window_coherence(level);
  CHECK(window_coherence.distance(window({10, 12}, {10, 12})) == 0);
  CHECK(window_coherence.distance(window({10, 12}, {11, 12})) < WindowCoherence::usual);
  CHECK(window_coherence.distance(window({10, 12}, {10, 11})) < WindowCoherence::usual);
}

TEST_CASE("the farther what meets lies apart, the less the window is like the exemplar") {
  const PaddedLevel exemplar = test::slopes(size);
  const std::vector<ExemplarPixel> none;
  const CorrectionLevel level = level_of(exemplar, none);
  const WindowCoherence window_coherence(level);
  int32_t before = 0, between = 0;
  for (int apart = 0; apart < 30; apart++) {
    const int32_t distance = window_coherence.distance(window({20, 12}, {uint16_t(20 + apart), 12}));
    CHECK(distance >= before);
    between += distance > 0 && distance < WindowCoherence::usual;
    before = distance;
  }
  CHECK(before > WindowCoherence::usual);
  CHECK(between > 0);
}

TEST_CASE("windows are found where similar pixels lead") {
  // A window whose left part there is once more, at another place, and its right part at a third.
  constexpr Size larger{128, 120};
  constexpr ExemplarPixel whole{20, 30}, left{90, 20}, right{40, 90};
  AppearanceLevel parts;
  parts.size = larger;
  const PaddedLevel plain = test::slopes(larger);
  for (int y = 0; y < larger.height; y++)
    for (int x = 0; x < larger.width; x++) parts.vectors.push_back(*plain.at(x, y));
  std::vector<ExemplarPixel> similar(parts.vectors.size(), ExemplarPixel{0, 0});
  for (int y = 0; y < WindowCoherence::side; y++)
    for (int x = 0; x < WindowCoherence::side; x++) {
      const ExemplarPixel& copy = x < 4 ? left : right;
      const size_t at = size_t(copy.y + y) * larger.width + copy.x + x;
      parts.vectors[at] = *plain.at(whole.x + x, whole.y + y);
      similar[at] = {uint16_t(whole.x + x), uint16_t(whole.y + y)};
    }
  const PaddedLevel exemplar(parts, false);
  const std::vector<ExemplarPixel> none;
  const CorrectionLevel without = level_of(exemplar, none), with = level_of(exemplar, similar, 1);
  CHECK(WindowCoherence(without).distance(window(left, right)) > WindowCoherence::usual);
  CHECK(WindowCoherence(with).distance(window(left, right)) == 0);
}

TEST_CASE("an exemplar smaller than a window is never unlike") {
  const PaddedLevel exemplar = test::slopes({6, 6});
  const std::vector<ExemplarPixel> none;
  const CorrectionLevel level = level_of(exemplar, none);
  WindowCoherence::Window shown{};
  shown[7] = {5, 5};
  CHECK(WindowCoherence(level).distance(shown) == 0);
}
