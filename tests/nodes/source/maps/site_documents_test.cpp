#include "nodes/source/maps/site_documents.h"

#include <doctest/doctest.h>

#include "core/image_io/image_file.h"
#include "nodes/common/registry.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

PhysicalSize said(const std::string& text) {
  const TemporaryFolder folder;
  write_text(folder.path() / "vdmlebxfw.json", text);
  Texts notes;
  const PhysicalSize size = metres_in_documents(folder.path(), notes);
  CHECK(notes.size() == (size.is_known() ? 1 : 0));
  return size;
}

}  // namespace

TEST_CASE("the data of a Megascans download say how large the surface is") {
  CHECK(said(R"({"physicalSize": "2x2"})") == PhysicalSize{2, 2});
  CHECK(
      said(
          R"({"id": "x", "meta": [{"key": "height", "value": "0.1 m"}, {"key": "scanArea", "value": "0.5 x 0.25 m"}]})") ==
      PhysicalSize{0.5, 0.25});
  CHECK(said(R"({"physicalSize": "unknown", "meta": [{"key": "scanArea", "value": "3x2"}]})") == PhysicalSize{3, 2});
}

TEST_CASE("documents that say nothing, or nonsense, are passed over") {
  for (const char* text :
       {"", "[", "[1]", "3", "{}", R"({"physicalSize": 2})", R"({"physicalSize": "2x"})", R"({"physicalSize": "0x0"})",
        R"({"physicalSize": "2x2 ft"})", R"({"physicalSize": "99999999x1"})", R"({"meta": 1})", R"({"meta": [1, {}]})",
        R"({"meta": [{"key": 1}, {"key": "scanArea"}]})", R"({"meta": [{"key": "scanArea", "value": [1]}]})"}) {
    CAPTURE(text);
    CHECK_FALSE(said(text).is_known());
  }
}

TEST_CASE("the physical size comes from the parameter, else from files' descriptions, else from the site") {
  const TemporaryFolder folder;
  const std::string path = folder.path().string();
  const auto write = [&](const std::string& description) {
    write_image(*make_image({8, 4}, 1, [](int x, int, int) { return float(x) / 8; }), folder.path() / "height.png",
                {.description = description}, [](double) {});
  };
  const auto metres = [&](const Numbers& given) {
    return run_node("load_material", {{"path", path}, {"metres", given}}).get<Material>("material")->metres();
  };
  write("");
  CHECK_FALSE(metres({}).is_known());
  write_text(folder.path() / "site.json", R"({"physicalSize": "4x2"})");
  CHECK(metres({}) == PhysicalSize{4, 2});
  CHECK(run_node("load_material", {{"path", path}}).says("the surface is 4 x 2 m, as site.json says"));
  write("terrazzo: height metres=3x1.5");
  CHECK(metres({}) == PhysicalSize{3, 1.5});
  CHECK(metres({5}) == PhysicalSize{5, 2.5});
  const Params params = {{"path", path}, {"maps", TextMap{}}};
  const auto files = find_node_type("load_material")->files_read(params);
  CHECK(std::find(files.begin(), files.end(), folder.path() / "site.json") != files.end());
}
