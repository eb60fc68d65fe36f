#include "core/base/suggest.h"

#include <doctest/doctest.h>

using namespace terrazzo;

TEST_CASE("the nearest name is the one that was most likely meant") {
  const std::vector<std::string> names = {"synthesize", "resize", "resolve_uv", "blur", "bool", "load_map"};
  CHECK(nearest("sinthesise", names) == "synthesize");
  CHECK(nearest("Resize", names) == "resize");
  CHECK(nearest("rezise", names) == "resize");
  CHECK(nearest("laod_map", names) == "load_map");
  CHECK(nearest("boolean", names) == "bool");
  CHECK(nearest("synth", names) == "synthesize");
  CHECK(nearest("heigth", {"weight", "height"}) == "height");
  CHECK(nearest("delite", {"blur", "delight"}) == "delight");
}

TEST_CASE("what joins words, and their case, do not make another name") {
  CHECK(nearest("for_each", {"format", "foreach"}) == "foreach");
  CHECK(nearest("A-O-Map", {"a_omal", "ao_map"}) == "ao_map");
  CHECK(nearest("ao", {"ao", "a_o"}) == "a_o");
}

TEST_CASE("no name is suggested that is nothing like what was written") {
  CHECK(nearest("quantum", {"blur", "pca"}) == "");
  CHECK(nearest("x", {"y", "z"}) == "");
  CHECK(nearest("", {"y", "z"}) == "");
  CHECK(nearest(std::string(1000, 'a'), {"aaa"}) == "");
  CHECK(nearest("blur", {}) == "");
}

TEST_CASE("how many letters may differ depends on how many there are") {
  CHECK(nearest("foto.png", {"photo.png", "fog.png"}) == "photo.png");
  CHECK(nearest("noise", {"nodes"}) == "");
  CHECK(nearest("size", {"seed", "side"}) == "side");
  CHECK(nearest("gray", {"crop"}) == "");
  CHECK(nearest("stone_hieght.png", {"stone_normal.png"}) == "");
  CHECK(nearest("stone_hieght.png", {"stone_normal.png", "stone_height.png"}) == "stone_height.png");
  CHECK(nearest("a.json", {"b.json"}) == "");
  CHECK(nearest("out_of_memory", {"out"}) == "");
  CHECK(nearest("mat", {"material"}) == "material");
}

TEST_CASE("other numbers are no misspelling") {
  CHECK(nearest("scan_03.png", {"scan_02.png"}) == "");
  CHECK(nearest("leather5", {"Leather05"}) == "Leather05");
  CHECK(nearest("maps2", {"maps"}) == "maps");
}

TEST_CASE("a suggestion falls back to the valid names") {
  CHECK(suggestion("blurr", {"blur", "pca"}) == " (did you mean \"blur\"?)");
  CHECK(suggestion("quantum", {"blur", "pca"}) == " (valid: \"blur\" or \"pca\")");
  CHECK(suggestion("quantum", {}) == "");
}

TEST_CASE("long lists of names are shortened") {
  CHECK(listed({"a"}) == "\"a\"");
  CHECK(listed({"a", "b", "c"}) == "\"a\", \"b\" or \"c\"");
  std::vector<std::string> names;
  for (int i = 0; i < 40; i++) names.push_back(std::to_string(i));
  CHECK(listed(names).ends_with("\"15\" and 24 more"));
}

TEST_CASE("each name is listed once") {
  CHECK(listed({"a", "b", "a", "a"}) == "\"a\" or \"b\"");
  CHECK(suggestion("quantum", {"pca", "pca"}) == " (valid: \"pca\")");
}
