#include "core/synthesis/state/labels.h"

#include <functional>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr Size side{80, 60};

ImagePtr painted(Size size, int channels, const std::function<float(int, int, int)>& value) {
  return make_image(size, channels, [&](int x, int y, int c) { return value(x, y, c); });
}

/// Two labels, 0.2 on the left and 0.8 on the right.
ImagePtr halves(Size size, int channels = 1) {
  return painted(size, channels, [=](int x, int, int) { return x < size.width / 2 ? 0.2f : 0.8f; });
}

PaintedLabels read(const ImagePtr& exemplar, const ImagePtr& target) {
  return painted_labels({.exemplar = exemplar, .target = target, .mode = Control::Mode::labels}, {32, 32}, side,
                        Task());
}

std::vector<uint8_t> layout(const std::function<int(int, int)>& label) {
  std::vector<uint8_t> out;
  for (int y = 0; y < side.height; y++)
    for (int x = 0; x < side.width; x++) out.push_back(uint8_t(label(x, y)));
  return out;
}

/// Whether a pixel wants nothing but its own label.
bool is_strict(const std::vector<uint8_t>& wanted, int count, int x, int y) {
  const uint8_t* labels = &wanted[(size_t(y) * side.width + x) * size_t(count)];
  return std::count(labels, labels + count, 255) == 1 && std::count(labels, labels + count, 0) == count - 1;
}

}  // namespace

TEST_CASE("labels are numbered alike in the exemplar and the target, at their sizes") {
  const PaintedLabels labels = read(halves({64, 64}), halves({20, 15}));
  CHECK(labels.count == 2);
  CHECK(labels.wanted == 2);
  CHECK(labels.unknown == 0);
  REQUIRE(labels.exemplar.size() == 32 * 32);
  REQUIRE(labels.target.size() == size_t(side.area()));
  CHECK(labels.exemplar[0] == labels.target[0]);
  CHECK(labels.exemplar[31] == labels.target[79]);
  CHECK(labels.exemplar[0] != labels.exemplar[31]);
}

TEST_CASE("grey layouts and coloured ones can be compared, whichever is grey") {
  for (const auto& [exemplar, target] : {std::pair(1, 3), std::pair(3, 1)}) {
    const PaintedLabels labels = read(halves({32, 32}, exemplar), halves({32, 32}, target));
    CHECK(labels.count == 2);
    CHECK(labels.unknown == 0);
    CHECK(labels.target[0] == labels.exemplar[0]);
    CHECK(labels.target[79] == labels.exemplar[31]);
  }
  CHECK_THROWS_WITH_AS(read(halves({32, 32}, 4), halves({32, 32}, 1)), doctest::Contains("as many channels"), Error);
}

TEST_CASE("values that the exemplar does not have count as the nearest, and it is known how many") {
  const ImagePtr target = painted(side, 1, [](int x, int, int) { return x < 20 ? 0.2f : x < 60 ? 0.3f : 0.31f; });
  const PaintedLabels labels = read(halves({32, 32}), target);
  CHECK(labels.unknown == doctest::Approx(0.75));
  CHECK(labels.wanted == 1);
  CHECK(labels.target[79] == labels.exemplar[0]);
  const ImagePtr values = painted({32, 32}, 1, [](int x, int y, int) { return float(x + 32 * y) / 1024; });
  CHECK_THROWS_WITH_AS(read(values, target), doctest::Contains("at most 32 different labels"), Error);
}

TEST_CASE("without leeway every pixel wants its own label") {
  const std::vector<uint8_t> target = layout([](int x, int y) { return (x + y) % 3; });
  const std::vector<uint8_t> wanted = wanted_labels(target, 3, side, 0, Task());
  for (int y = 0; y < side.height; y++)
    for (int x = 0; x < side.width; x++) REQUIRE(is_strict(wanted, 3, x, y));
}

TEST_CASE("with leeway borders are free as far as that, and those labels alone that are so near") {
  const std::vector<uint8_t> target = layout([](int x, int) { return x < 30 ? 0 : x < 60 ? 1 : 2; });
  const std::vector<uint8_t> wanted = wanted_labels(target, 3, side, 5, Task());
  const auto at = [&](int x) { return &wanted[(size_t(20) * side.width + size_t(x)) * 3]; };
  for (const int x : {0, 24, 35, 54, 65}) CHECK(is_strict(wanted, 3, x, 20));
  for (const int x : {25, 29, 30, 34}) {
    CHECK(int(at(x)[0]) == 127);
    CHECK(int(at(x)[1]) == 127);
    CHECK(int(at(x)[2]) == 0);
  }
  CHECK(int(at(60)[0]) == 0);
  CHECK(int(at(60)[2]) == 127);
}

TEST_CASE("what is thin stays, and what is around it gives way") {
  const std::vector<uint8_t> target = layout([](int x, int y) { return y >= 30 && y < 34 && x > 20 ? 1 : 0; });
  const std::vector<uint8_t> wanted = wanted_labels(target, 2, side, 6, Task());
  for (const int x : {22, 50, 79}) {
    CHECK(is_strict(wanted, 2, x, 31));
    CHECK_FALSE(is_strict(wanted, 2, x, 27));
  }
  // Corners of what is large are no thin parts.
  const std::vector<uint8_t> box =
      wanted_labels(layout([](int x, int y) { return x > 20 && y > 20; }), 2, side, 6, Task());
  CHECK_FALSE(is_strict(box, 2, 21, 21));
  CHECK(is_strict(box, 2, 30, 30));
}
