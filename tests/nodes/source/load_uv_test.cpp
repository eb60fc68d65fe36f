#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/image_io/image_file.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

MaterialPtr exemplar(Size size) {
  return Material::of(make_image(size, 1, [](int, int, int) { return 0.5f; }));
}

}  // namespace

TEST_CASE("a uv map comes back exactly from every format that export writes it in") {
  const TemporaryFolder folder;
  std::vector<ExemplarPixel> pixels;
  for (int i = 0; i < 60 * 50; i++) pixels.push_back({uint16_t((i * 7) % 300), uint16_t((i * 11) % 200)});
  const UvMapPtr uv = UvMap::make({60, 50}, {300, 200}, pixels, {.y = true, .exemplar = true});
  for (const std::string name : {"uv.png", "uv.tif", "uv.exr"}) {
    const std::string path = (folder.path() / name).string();
    run_node("export", {{"uv_path", path}}, {{"uv", {uv}}});
    const UvMapPtr back = run_node("load_uv", {{"path", path}, {"tileable", "y"}, {"wraps", true}},
                                   {{"exemplar", {exemplar({300, 200})}}})
                              .get<UvMap>("uv");
    CHECK(back->pixels() == pixels);
    CHECK(back->digest() == uv->digest());
    if (name != "uv.exr")
      CHECK(error_of("load_uv", {{"path", path}}, {{"exemplar", {exemplar({64, 64})}}})
                .find("outside the exemplar of 64x64") != std::string::npos);
  }
}

TEST_CASE("a picture that is no uv map is refused with what was found") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "photo.png").string();
  write_image(*make_image({8, 8}, 3, [](int, int, int) { return 0.5f; }), path,
              {.format = FileFormat::png, .depth = Depth::u8}, [](double) {});
  CHECK(error_of("load_uv", {{"path", path}}, {{"exemplar", {exemplar({64, 64})}}}).find("found 3 channels of uint8") !=
        std::string::npos);
}
