#include "core/base/text.h"

#include <string>

#include <doctest/doctest.h>

namespace terrazzo {

TEST_CASE("patterns match whole names") {
  CHECK(matches_pattern("rock_COLOR.png", "*_color.*"));
  CHECK(matches_pattern("a1.png", "a?.png"));
  CHECK_FALSE(matches_pattern("a12.png", "a?.png"));
  CHECK_FALSE(matches_pattern("color.png.txt", "*.png"));
  CHECK(matches_pattern("a_color_b_color.png", "*_color.png"));
  CHECK(matches_pattern("", "*"));
  CHECK_FALSE(matches_pattern("a", ""));
  CHECK_FALSE(matches_pattern(std::string(60, 'a'), "*a*a*a*a*a*a*a*a*a*a*a*a*b"));  // at once
}

}  // namespace terrazzo
