#include <doctest/doctest.h>

#include "core/base/error.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

ImagePtr grey(float value) {
  return make_image({16, 16}, 1, [=](int, int, int) { return value; });
}

ImagePtr sheet(const Params& params, const std::vector<Value>& images) {
  return run_node("contact_sheet", params, {{"images", images}}).get<Image>("image");
}

}  // namespace

TEST_CASE("contact_sheet lays pictures out in the order of their wires") {
  const ImagePtr image =
      sheet({{"columns", int64_t{2}}, {"cell", Size{16, 16}}, {"gap", int64_t{1}}}, {grey(0), grey(0.5f), grey(1)});
  REQUIRE(image->size() == Size{1 + 16 + 1 + 16 + 1, 1 + 16 + 1 + 16 + 1});
  CHECK(image->read({1, 1, 1, 1})[0] == 0);
  CHECK(image->read({18, 1, 1, 1})[0] == 0.5f);
  CHECK(image->read({1, 18, 1, 1})[0] == 1);
}

TEST_CASE("contact_sheet enlarges and captions if asked, and names the parameter that is wrong") {
  CHECK(sheet({{"enlarge", true}}, {grey(1)})->read({8, 8, 1, 1})[0] == 1);
  CHECK(sheet({}, {grey(1)})->read({8, 8, 1, 1})[0] < 1);
  CHECK(sheet({{"captions", Texts{"one"}}}, {grey(1)})->height() > sheet({}, {grey(1)})->height());
  CHECK_THROWS_WITH_AS(sheet({{"captions", Texts{"one", "two"}}}, {grey(1)}), doctest::Contains("found 2"), Error);
}
