#include <cmath>
#include <filesystem>

#include <doctest/doctest.h>

#include "core/image_io/image_file.h"
#include "nodes/common/registry.h"
#include "tests/odd_images.h"
#include "tests/run_node.h"
#include "tests/texts.h"

/// Orientation tags that the files of a material do not share.
using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

float surface(int x, int y) {
  return float(0.5 + 0.2 * std::sin(x * 0.4 + y * 0.2) + 0.15 * std::sin(x * 0.17 - y * 0.5) +
               0.1 * std::sin(0.002 * x * x + 0.3 * y));
}

/// Where the upright picture of `size` is stored under an orientation tag.
std::pair<int, int> upright(int orientation, Size size, int x, int y) {
  const int right = size.width - 1, bottom = size.height - 1;
  switch (orientation) {
    case 3:
      return {right - x, bottom - y};
    case 6:
      return {right - y, x};
    case 8:
      return {y, bottom - x};
    default:
      return {x, y};
  }
}

/// A picture of the surface, `channels` of it, that is upright once its tag is followed, or as it is stored.
void write(const fs::path& path, Size size, int channels, int tag, bool fits_stored,
           const std::function<float(int, int)>& value = surface) {
  const bool is_turned = tag >= 5 && !fits_stored;
  const Size stored = is_turned ? Size{size.height, size.width} : size;
  std::vector<float> pixels;
  for (int y = 0; y < stored.height; y++)
    for (int x = 0; x < stored.width; x++)
      for (int c = 0; c < channels; c++) {
        const auto [u, v] = fits_stored ? std::pair(x, y) : upright(tag, size, x, y);
        pixels.push_back(value(u, v) * (c == 1 ? 0.8f : 1.0f));
      }
  write_odd(path, {.size = stored, .channels = channels, .attributes = {{"Orientation", tag}}}, pixels);
}

NodeRun load(const fs::path& folder, const TextMap& interpret = {}) {
  return run_node("load_material", {{"path", folder.string()}, {"interpret", interpret}});
}

/// Whether the map shows the surface as it is.
bool is_right(const NodeRun& run, const char* map) {
  const ImagePtr image = run.get<Material>("material")->find(map);
  double worst = 0;
  for (const auto& [x, y] : {std::pair(3, 5), {20, 9}, {9, 25}})
    worst = std::max(worst, double(std::abs(image->read({x, y, 1, 1})[0] - surface(x, y))));
  return worst < 0.05;
}

}  // namespace

TEST_CASE("a map whose tag turns it away from the others is read as it is stored, with a warning") {
  for (const int tag : {3, 6, 8})
    for (const char* file : {"wall_color.jpg", "wall_color.tif"}) {
      CAPTURE(tag);
      const TemporaryFolder folder;
      write(folder.path() / file, {64, 64}, 3, tag, true);
      write(folder.path() / "wall_height.png", {64, 64}, 1, 1, true);
      const NodeRun run = load(folder.path());
      CHECK(is_right(run, "base_color"));
      CHECK(run.says(std::string("warning: ") + file + ": its orientation tag (" + std::to_string(tag) +
                     ") is ignored: as stored it fits wall_height.png"));
      CHECK(
          run.says("`interpret` {\"base_color\": \"as_tagged\"} (of synth and new: --interpret base_color=as_tagged)"));
      CHECK_FALSE(run.says("rotated upright"));
      const NodeRun tagged = load(folder.path(), {{"base_color", "as_tagged"}});
      CHECK_FALSE(is_right(tagged, "base_color"));
      CHECK_FALSE(tagged.says("warning: wall_color"));
    }
}

TEST_CASE("a map whose tag makes it fit the others is turned") {
  const TemporaryFolder folder;
  write(folder.path() / "wall_color.tif", {64, 64}, 3, 6, false);
  write(folder.path() / "wall_height.png", {64, 64}, 1, 1, true);
  const NodeRun run = load(folder.path());
  CHECK(is_right(run, "base_color"));
  CHECK(run.says("rotated upright"));
  CHECK(run.says("turned so, it fits wall_height.png"));
  CHECK_FALSE(run.says("warning"));
  CHECK_FALSE(is_right(load(folder.path(), {{"base_color", "as_stored"}}), "base_color"));
}

TEST_CASE("the shapes of the pictures tell it where they are not square") {
  for (const bool fits_stored : {true, false}) {
    const TemporaryFolder folder;
    write(folder.path() / "wall_color.tif", {64, 48}, 3, 6, fits_stored);
    write(folder.path() / "wall_height.png", {64, 48}, 1, 1, true, [](int, int) { return 0.5f; });
    const NodeRun run = load(folder.path());
    CHECK(is_right(run, "base_color"));
    CHECK(run.says("as stored, 64x48, it has the shape of the other maps") == fits_stored);
    const Forecast seen = find_node_type("load_material")
                              ->preflight({{"path", folder.path().string()},
                                           {"name", std::string()},
                                           {"maps", TextMap{}},
                                           {"ignore", Texts{}},
                                           {"data", Texts{}}},
                                          {});
    CHECK(seen.images.at("base_color").size == Size{64, 48});
  }
}

TEST_CASE("maps of one tag are all turned") {
  const TemporaryFolder folder;
  write(folder.path() / "wall_color.tif", {64, 64}, 3, 6, false);
  write(folder.path() / "wall_height.tif", {64, 64}, 1, 6, false);
  const NodeRun run = load(folder.path());
  CHECK(is_right(run, "base_color"));
  CHECK(is_right(run, "height"));
  CHECK_FALSE(run.says("warning"));
}

TEST_CASE("what the pixels do not tell is asked, and what makes no difference is not") {
  const TemporaryFolder folder;
  const auto noise = [](int x, int y) { return float((x * 7919 + y * 104729 + x * y * 31) % 251) / 250; };
  write(folder.path() / "wall_color.tif", {64, 64}, 3, 6, true);
  write(folder.path() / "wall_height.png", {64, 64}, 1, 1, true, noise);
  const std::string error = error_of("load_material", {{"path", folder.path().string()}});
  CHECK(contains(error, "wall_color.tif: its orientation tag (6) turns it"));
  CHECK(contains(error, "`interpret` {\"base_color\": \"as_stored\"}"));
  CHECK(is_right(load(folder.path(), {{"base_color", "as_stored"}}), "base_color"));
  write(folder.path() / "wall_height.png", {64, 64}, 1, 1, true);
  write(folder.path() / "wall_color.tif", {64, 64}, 3, 6, true, [](int, int) { return 0.25f; });
  CHECK(load(folder.path()).get<Material>("material")->map_names() == "base_color, height");
}

TEST_CASE("load_map follows the tag, or what it is told") {
  const TemporaryFolder folder;
  write(folder.path() / "a.tif", {64, 48}, 3, 6, true);
  const std::string path = (folder.path() / "a.tif").string();
  CHECK(run_node("load_map", {{"path", path}}).get<Image>("image")->size() == Size{48, 64});
  const NodeRun stored = run_node("load_map", {{"path", path}, {"interpret", "as_stored"}});
  CHECK(stored.get<Image>("image")->size() == Size{64, 48});
  CHECK_FALSE(stored.says("rotated"));
}
