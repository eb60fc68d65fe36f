#include "core/synthesis/steps.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "core/synthesis/synthesize.h"
#include "test_paths.h"
#include "tests/drawn_panels.h"
#include "tests/drawn_stones.h"
#include "tests/drawn_tiles.h"
#include "tests/drawn_wall.h"
#include "tests/exemplars.h"

/// The uv field after every step on every level is the one in steps.txt: where results differ, the first step that does
/// is named.
using namespace terrazzo;
using namespace terrazzo::test;

namespace {

struct SteppedCase {
  std::string name;
  IndexPtr index;
  SynthesisOptions options;
};

IndexPtr indexed(const FeaturesPtr& features) {
  return make_index(make_appearance(*features, {}, {}, Task()), 3, Task());
}

ImagePtr grey_squares(Size size) {
  return make_image(size, 1, [](int x, int y, int) { return (x / 16 + y / 16) % 2 ? 1.0f : 0.0f; });
}

/// They leave no step out.
std::vector<SteppedCase> stepped_cases() {
  const Size wall_size{136, 128}, size{120, 112};
  const IndexPtr plain = indexed(plain_features(wall(wall_size)));
  const Lattice lattice{2, {16, 0}, {8, 8}, 0.9};
  const DrawnWall courses({160, 150});
  const DrawnStones stones({160, 160}, 4);
  const auto known = [&](double certainty) {
    Elements elements = stones.elements();
    elements.certainty = certainty;
    return plain_features(stones.image(), true)->with(std::make_shared<const Elements>(elements));
  };

  SynthesisOptions kept{.size = size};
  const UvMapPtr before = synthesize(*plain, {.size = size, .seed = 2}, Task());
  kept.kept.pixels.assign(before->pixels().begin(), before->pixels().end());
  for (int i = 0; i < int(size.area()); i++)
    kept.kept.keep.push_back(i % size.width < size.width / 2 ? Keep::always : Keep::never);

  SynthesisOptions steered{.size = size};
  steered.controls = {
      {.exemplar = grey_squares(wall_size), .target = grey_squares(size), .mode = Control::Mode::labels}};
  return {
      {"plain", plain, {.size = size, .jitter = {3, 2, 1}}},
      {"best", plain, {.size = size, .tile_x = true, .tile_y = true, .quality = Quality::best}},
      {"draft", plain, {.size = size, .quality = Quality::draft}},
      {"small", wall_index(), {.size = {60, 44}}},
      {"lattice", indexed(plain_features(wall(wall_size))->with(lattice)), {.size = size}},
      {"courses", indexed(courses.features()), {.size = {200, 180}}},
      {"stones", indexed(known(1)), {.size = {200, 180}}},
      {"heap", indexed(known(0.3)), {.size = {200, 180}}},
      {"tiles", DrawnTiles(10).index(true), {.size = {100, 90}}},
      {"grid", DrawnTiles(72).crooked().index(true), {.size = {200, 180}}},
      {"panels", make_index(DrawnPanels(false).appearance(), 3, Task()), {.size = {300, 250}}},
      {"kept", plain, kept},
      {"steered", plain, steered},
  };
}

/// A line for each level, "case level step=digest ...": the field after each run of a step, "-" where it is as before.
std::vector<std::string> steps_of(const SteppedCase& c) {
  std::vector<std::string> lines;
  int level = -1;
  Digest last;
  watch_steps([&](const Step& step, const StepContext& context, double) {
    if (context.facts.level != level) lines.push_back(fmt::format("{} {}", c.name, context.facts.level));
    level = context.facts.level;
    const std::vector<ExemplarPixel>& pixels = context.field.pixels;
    Hasher h;
    h.add(context.field.size.width).bytes(pixels.data(), pixels.size() * sizeof(ExemplarPixel));
    const Digest now = h.digest();
    lines.back() += fmt::format(" {}={}", step.name, now == last || pixels.empty() ? "-" : now.hex().substr(0, 8));
    last = now;
  });
  synthesize(*c.index, c.options, Task());
  watch_steps({});
  return lines;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), {}};
}

/// What the first of them is that differs; empty: none.
std::string first_difference(const std::vector<std::string>& now, const std::vector<std::string>& recorded) {
  const auto line_of = [](const std::vector<std::string>& lines, size_t i) {
    return i < lines.size() ? words_of(lines[i]) : std::vector<std::string>();
  };
  for (size_t i = 0; i < std::max(now.size(), recorded.size()); i++) {
    const std::vector<std::string> a = line_of(now, i), b = line_of(recorded, i);
    const auto [found, expected] = std::ranges::mismatch(a, b);
    if (found == a.end() && expected == b.end()) continue;
    const std::vector<std::string>& named = a.empty() ? b : a;
    return fmt::format("{}, level {}: the first step that differs is {} (the {}th run), recorded is {}", named[0],
                       named[1], found == a.end() ? "none" : *found, found - a.begin() - 1,
                       expected == b.end() ? "none" : *expected);
  }
  return "";
}

std::vector<std::string> recorded_steps(const std::filesystem::path& path, const std::string& name) {
  std::vector<std::string> lines;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(name + " ")) lines.push_back(line);
  return lines;
}

}  // namespace

TEST_SUITE_BEGIN("golden");

TEST_CASE("golden results: synthesis, step by step") {
  const char* target = std::getenv("TERRAZZO_GOLDEN_RECORD");
  const std::filesystem::path folder =
      target ? std::filesystem::path(target) : std::filesystem::path(TERRAZZO_SOURCE_DIR) / "tests" / "golden";
  std::string record = "# The uv field after every step of the synthesis. Made anew by tests/golden/regenerate.sh.\n";
  std::set<std::string> seen;
  for (const SteppedCase& c : stepped_cases()) {
    const std::vector<std::string> now = steps_of(c);
    for (const std::string& line : now) {
      record += line + "\n";
      for (const std::string& word : words_of(line)) seen.insert(word.substr(0, word.find('=')));
    }
    if (target) continue;
    const std::string difference = first_difference(now, recorded_steps(folder / "steps.txt", c.name));
    CHECK_MESSAGE(difference.empty(), difference);
  }
  if (target) std::ofstream(folder / "steps.txt") << record;
  for (const Step& step : synthesis_steps()) CHECK_MESSAGE(seen.count(std::string(step.name)), step.name);
}

TEST_SUITE_END();
