#include "core/picture/pixel_font.h"

#include <set>
#include <string>
#include <vector>

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

/// What a text looks like, row by row.
std::string drawn(const std::string& text) {
  const int width = character_count(text) * glyph_advance;
  std::string out(size_t(width + 1) * glyph_height, ' ');
  for (int y = 1; y <= glyph_height; y++) out[size_t(y) * (width + 1) - 1] = '\n';
  for_each_dot(text, [&](int x, int y) { out.at(size_t(y) * (width + 1) + x) = '#'; });
  return out;
}

const std::string known = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.,:;!?'\"()[]+-*/=_<>%#&";

}  // namespace

TEST_CASE("characters are drawn side by side") {
  CHECK(drawn("T1") ==
        "#####   #   \n"
        "  #    ##   \n"
        "  #     #   \n"
        "  #     #   \n"
        "  #     #   \n"
        "  #     #   \n"
        "  #    ###  \n");
}

TEST_CASE("every character of the font looks different") {
  std::set<std::string> looks = {drawn(" ")};
  for (const char c : known) CHECK_MESSAGE(looks.insert(drawn({c})).second, c);
}

TEST_CASE("small letters are capitals; what the font lacks is one box per character") {
  CHECK(drawn("az") == drawn("AZ"));
  CHECK(drawn("\xc3\xa4") == drawn("~"));
  CHECK(drawn("~") != drawn(" "));
  CHECK(character_count("a\xc3\xa4\xe2\x82\xac") == 3);
}

TEST_CASE("long texts end in two dots, and no character is cut in half") {
  CHECK(shortened("weights", 7) == "weights");
  CHECK(shortened("weights", 6) == "weig..");
  CHECK(shortened("\xc3\xa4\xc3\xb6\xc3\xbc\xc3\x9f", 3) == "\xc3\xa4..");
  CHECK(shortened("weights", 2) == "..");
  CHECK(shortened("weights", 1).empty());
}

TEST_CASE("captions break at spaces, and what does not fit is shortened") {
  using Lines = std::vector<std::string>;
  CHECK(wrapped("seed=3, size=512", 20, 3) == Lines{"seed=3, size=512"});
  CHECK(wrapped("seed=3, size=512", 9, 3) == Lines{"seed=3,", "size=512"});
  CHECK(wrapped(" one  two three four", 5, 2) == Lines{"one", "two.."});
  CHECK(wrapped("incomprehensible word", 6, 3) == Lines{"inco..", "word"});
  CHECK(wrapped("", 6, 3).empty());
  CHECK(wrapped("  ", 6, 3).empty());
  CHECK(wrapped("no room", 1, 3).empty());
}
