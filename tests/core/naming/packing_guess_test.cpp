#include "core/naming/packing_guess.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

#include <doctest/doctest.h>

#include "core/procedural/pattern.h"
#include "test_paths.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

/// Maps of a material that can be packed.
struct Parts {
  ImagePtr occlusion, roughness, height, color;
};

using Value = std::function<float(int, int)>;

ImagePtr packed(Size size, const std::vector<Value>& channels) {
  return make_image(size, int(channels.size()), [&](int x, int y, int c) { return channels[size_t(c)](x, y); });
}

Value of(const ImagePtr& image, bool inverted = false) {
  const std::vector<float> pixels = image->pixels();
  const int width = image->width(), channels = image->channels();
  return [=](int x, int y) {
    const float v = pixels[size_t(y * width + x) * size_t(channels)];
    return inverted ? 1 - v : v;
  };
}

Value constant(float v) {
  return [v](int, int) { return v; };
}

std::string told(const PackingGuess& guess) {
  std::string out;
  for (const GuessedMap& m : guess.maps)
    out += std::string(1, m.channel) + (m.inverted ? "!" : "=") + name_of(m.semantic).data() + " ";
  return out;
}

const std::string orm = "r=ambient_occlusion g=roughness b=metallic ";

/// What the packings of a material are taken for; wrong guesses fail, `found` counts right ones.
void check_packings(const Parts& p, bool with_height, int& found, int& all) {
  const Size size = p.roughness->size();
  const Value o = of(p.occlusion), r = of(p.roughness), s = of(p.roughness, true), m = constant(0);
  const ImagePtr height = with_height ? p.height : nullptr;
  const std::vector<std::pair<ImagePtr, std::string>> cases = {
      {packed(size, {o, r, m}), orm},
      {packed(size, {r, m, o}), "r=roughness g=metallic b=ambient_occlusion "},
      {packed(size, {m, r, o}), "r=metallic g=roughness b=ambient_occlusion "},
      {packed(size, {m, o, constant(0.5f), s}), "r=metallic g=ambient_occlusion a!roughness "}};
  for (const auto& [file, expected] : cases) {
    const std::string guess = told(guess_packing(file, height));
    CHECK((guess.empty() || guess == expected));
    found += guess == expected;
    all++;
  }
}

}  // namespace

TEST_CASE("the packings of generated materials are told by their pixels") {
  // These are not told, nor mistaken; all others are told.
  const std::set<std::string> left_alone = {"planks", "chevron", "plates", "flagstones", "sheet_metal"};
  int found = 0, all = 0;
  for (const PatternType& type : pattern_types()) {
    CAPTURE(type.name);
    const auto m = run_node("pattern", {{"kind", type.name}, {"size", Size{128, 128}}}).get<Material>("material");
    if (!m->find("ambient_occlusion") || !m->find("roughness")) continue;
    const Parts parts{m->find("ambient_occlusion"), m->find("roughness"), m->find("height"), m->find("base_color")};
    const int before = found;
    check_packings(parts, true, found, all);
    CHECK((found == before + 4 || left_alone.contains(type.name)));
    CHECK(told(guess_packing(m->find("base_color"), m->find("height"))).empty());
    CHECK(told(guess_packing(m->find("base_color"), nullptr)).empty());
    CHECK(told(guess_packing(m->find("normal"), m->find("height"))).empty());
  }
  CHECK(all >= 16);
  MESSAGE(found, " of ", all);
}

TEST_CASE("the packings of the exemplars are told or left alone, never mistaken") {
  const char* given = std::getenv("TERRAZZO_EXEMPLARS");
  const fs::path folder = given ? given : fs::path(TERRAZZO_SOURCE_DIR) / "../shared/exemplars";
  if (!fs::is_directory(folder)) {
    MESSAGE("skipped: no exemplars in ", folder.string(), " (set TERRAZZO_EXEMPLARS)");
    return;
  }
  int found = 0, all = 0, found_alone = 0, all_alone = 0;
  for (const fs::directory_entry& e : fs::directory_iterator(folder)) {
    CAPTURE(e.path().string());
    const auto m = run_node("load_material", {{"path", e.path().string()}}).get<Material>("material");
    const ImagePtr height = m->find("height");
    CHECK(told(guess_packing(m->find("base_color"), height)).empty());
    CHECK(told(guess_packing(m->find("base_color"), nullptr)).empty());
    if (!m->find("roughness") || !m->find("ambient_occlusion")) continue;
    const Parts parts{m->find("ambient_occlusion"), m->find("roughness"), height, m->find("base_color")};
    check_packings(parts, true, found, all);
    check_packings(parts, false, found_alone, all_alone);
  }
  MESSAGE(found, " of ", all, " with a height map, ", found_alone, " of ", all_alone, " without");
  CHECK(found * 2 >= all);
}
