#include <cmath>
#include <filesystem>

#include <doctest/doctest.h>

#include "core/image_io/image_file.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

constexpr Size size{64, 64};

float surface(int x, int y) {
  return float(0.5 + 0.2 * std::sin(x * 0.4 + y * 0.2) + 0.15 * std::sin(x * 0.17 - y * 0.5));
}

void write(const fs::path& path, int channels, const std::function<float(int, int, int)>& value) {
  write_image(*make_image(size, channels, value), path, {.depth = Depth::u16}, [](double) {});
}

/// A depth map in which near is dark, or bright.
void write_depth(const fs::path& folder, bool near_is_dark) {
  write(folder / "wall_depth.png", 1,
        [=](int x, int y, int) { return near_is_dark ? 1 - surface(x, y) : surface(x, y); });
}

void write_normals(const fs::path& folder) {
  write(folder / "wall_normal.png", 3, [](int x, int y, int c) {
    const float u = 4 * (surface(x - 1, y) - surface(x + 1, y)), v = 4 * (surface(x, y + 1) - surface(x, y - 1));
    return 0.5f + 0.5f * (c == 0 ? u : c == 1 ? v : 1) / std::sqrt(u * u + v * v + 1);
  });
}

bool is_upright(const NodeRun& run, const std::string& map = "height") {
  const ImagePtr height = run.get<Material>("material")->find(map);
  return std::abs(height->read({9, 9, 1, 1})[0] - surface(9, 9)) < 1e-4;
}

}  // namespace

TEST_CASE("a depth map in which near is dark is inverted where normals tell it") {
  const TemporaryFolder folder;
  write_depth(folder.path(), true);
  write_normals(folder.path());
  const Params params = {{"path", folder.path().string()}};
  const NodeRun run = run_node("load_material", params);
  CHECK(is_upright(run));
  CHECK(run.says("near is dark in it by the normals"));
  CHECK(run.says("`interpret` {\"height\": \"not_inverted\"} (of synth and new: --interpret height=not_inverted)"));
  CHECK_FALSE(run.says("Invert the one that is wrong"));
  Params as_is = params;
  as_is["interpret"] = TextMap{{"height", "not_inverted"}};
  const NodeRun left = run_node("load_material", as_is);
  CHECK_FALSE(is_upright(left));
  CHECK(left.says("Invert the one that is wrong; `interpret` {\"height\": \"inverted\"}"));
  write_depth(folder.path(), false);
  const NodeRun bright = run_node("load_material", params);
  CHECK(is_upright(bright));
  CHECK_FALSE(bright.says("depth map"));
}

TEST_CASE("occlusion tells it too") {
  const TemporaryFolder folder;
  for (const bool near_is_dark : {true, false}) {
    write_depth(folder.path(), near_is_dark);
    write(folder.path() / "wall_ao.png", 1, [](int x, int y, int) { return surface(x, y) * 0.5f + 0.4f; });
    const NodeRun run = run_node("load_material", {{"path", folder.path().string()}});
    CHECK(is_upright(run));
    CHECK(run.says("by the occlusion") == near_is_dark);
  }
}

TEST_CASE("where nothing tells it, a note says how to invert, and that way works") {
  const TemporaryFolder folder;
  write_depth(folder.path(), true);
  const Params params = {{"path", folder.path().string()}};
  const NodeRun run = run_node("load_material", params);
  CHECK_FALSE(is_upright(run));
  CHECK(
      run.says("If near is dark in it, `interpret` {\"height\": \"inverted\"} (of synth and new: --interpret "
               "height=inverted) inverts it"));
  Params inverted = params;
  inverted["interpret"] = TextMap{{"height", "inverted"}};
  const NodeRun turned = run_node("load_material", inverted);
  CHECK(is_upright(turned));
  CHECK_FALSE(turned.says("depth map"));
  const std::string path = (folder.path() / "wall_depth.png").string();
  const Params one = {{"path", path}, {"semantic", "height"}};
  CHECK(run_node("load_map", one).says("`interpret` \"inverted\" inverts it"));
  Params other = one;
  other["interpret"] = "inverted";
  const NodeRun map = run_node("load_map", other);
  CHECK(map.get<Image>("image")->read({9, 9, 1, 1})[0] == doctest::Approx(surface(9, 9)).epsilon(0.001));
  CHECK(map.notes.empty());
}

TEST_CASE("a height map that is called so is never inverted without being asked") {
  const TemporaryFolder folder;
  write(folder.path() / "wall_height.png", 1, [](int x, int y, int) { return 1 - surface(x, y); });
  write_normals(folder.path());
  const NodeRun run = run_node("load_material", {{"path", folder.path().string()}});
  CHECK_FALSE(is_upright(run));
  CHECK(run.says("Invert the one that is wrong"));
}
