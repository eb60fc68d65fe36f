#include "nodes/source/maps/normal_checks.h"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr int side = 48;

float bump(int x, int y) {
  return float(0.5 + 0.2 * std::sin(x * 0.6 + y * 0.2) * std::cos(y * 0.5) + 0.1 * std::sin(x * 0.31));
}
float along_x(int x, int y) {
  return bump(x - 1, y) - bump(x + 1, y);
}
float along_y(int x, int y) {
  return bump(x, y + 1) - bump(x, y - 1);
}

/// The warnings about a normal map whose red and green are those functions.
std::string warnings(const std::function<float(int, int)>& red, const std::function<float(int, int)>& green,
                     float blue = 1) {
  const auto value = [&](int x, int y, int c) { return c == 2 ? blue : 0.5f + (c == 0 ? red(x, y) : green(x, y)); };
  std::vector<Map> maps = {
      {"normal", make_image({side, side}, 3, value, Semantic::normal)},
      {"height", make_image(
                     {side, side}, 1, [](int x, int y, int) { return bump(x, y); }, Semantic::height)}};
  std::vector<std::string> notes;
  settle_normals("auto", {{.map = "normal", .semantic = Semantic::normal, .file = "normal.png", .channels = ""}}, maps,
                 notes);
  std::string out;
  for (const std::string& n : notes)
    if (n.starts_with("warning: ")) out += n + "\n";
  return out;
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("normals that fit their height are no warning, whichever way green points") {
  CHECK(warnings(along_x, along_y) == "");
  CHECK(warnings(along_x, [](int x, int y) { return -along_y(x, y); }) == "");
}

TEST_CASE("normals that disagree with their height in another way than green's sign are a warning that says which") {
  CHECK(says(warnings(along_y, along_x), "red and green are swapped, or the normals are turned by 90 degrees"));
  CHECK(says(warnings(along_y, [](int x, int y) { return -along_x(x, y); }), "turned by 90 degrees"));
  CHECK(says(warnings([](int x, int y) { return -along_x(x, y); }, along_y), "green points up and red is flipped"));
  CHECK(says(warnings([](int x, int y) { return -along_x(x, y); }, [](int x, int y) { return -along_y(x, y); }),
             "the normals are turned by 180 degrees"));
  CHECK(says(warnings(along_x, along_y, 0), "the normals point into the surface"));
}

TEST_CASE("a normal map whose picture was turned or mirrored is told with how") {
  const int last = side - 1;
  const auto shown_at = [&](auto&& place) {
    return warnings([place](int x, int y) { return along_x(place(x, y).first, place(x, y).second); },
                    [place](int x, int y) { return along_y(place(x, y).first, place(x, y).second); });
  };
  CHECK(says(shown_at([&](int x, int y) { return std::pair(y, last - x); }), "was turned clockwise by 90 degrees"));
  CHECK(says(shown_at([&](int x, int y) { return std::pair(last - y, x); }),
             "was turned counter-clockwise by 90 degrees"));
  CHECK(says(shown_at([&](int x, int y) { return std::pair(last - x, last - y); }), "was turned by 180 degrees"));
  CHECK(says(shown_at([&](int x, int y) { return std::pair(last - x, y); }), "was mirrored left to right"));
  CHECK(says(shown_at([&](int x, int y) { return std::pair(x, last - y); }), "was mirrored top to bottom"));
}
