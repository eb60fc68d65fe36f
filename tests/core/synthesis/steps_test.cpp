#include "core/synthesis/steps.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <doctest/doctest.h>

#include "test_paths.h"

namespace terrazzo {

TEST_CASE("steps stand in the order of their phases, each named after its file") {
  const auto steps = synthesis_steps();
  CHECK(std::is_sorted(steps.begin(), steps.end(), [](const Step& a, const Step& b) { return a.phase < b.phase; }));
  for (const Step& s : steps) {
    CAPTURE(s.name);
    CHECK(!s.purpose.empty());
    const std::filesystem::path rooms = std::filesystem::path(TERRAZZO_SOURCE_DIR) / "core/synthesis";
    const std::string file = std::string(s.name) + ".h";
    CHECK((std::filesystem::exists(rooms / "steps" / file) || std::filesystem::exists(rooms / "state" / file)));
  }
}

TEST_CASE("every step is explained in the guide, and has its section of experiments") {
  const auto read = [](const std::string& path) {
    std::ifstream in(std::string(TERRAZZO_SOURCE_DIR) + "/" + path);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  };
  std::string guide = read("examples/guide/how-synthesis-works.md");
  for (char& c : guide) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c == '_' ? ' ' : c;
  const std::string experiments = read("tests/bench/experiments.md");
  for (const Step& s : synthesis_steps()) {
    CAPTURE(std::string(s.name));
    std::string words(s.name);
    std::replace(words.begin(), words.end(), '_', ' ');
    CHECK_MESSAGE(guide.find(words) != guide.npos, "examples/guide/how-synthesis-works.md does not name it");
    CHECK_MESSAGE(experiments.find("## " + std::string(s.name) + "\n") != experiments.npos,
                  "tests/bench/experiments.md has no heading of its name");
  }
}

TEST_CASE("use counts on coarse levels, but not where few passes put right what it breaks") {
  const auto counted = [](int levels) {
    std::vector<int> out;
    for (int level = 0; level < levels; level++)
      if (LevelFacts{.level = level, .levels = levels}.counts_use()) out.push_back(level);
    return out;
  };
  CHECK(counted(5) == std::vector<int>{1, 2, 3, 4});
  CHECK(counted(4) == std::vector<int>{1, 2, 3});
  CHECK(counted(3) == std::vector<int>{2});
  CHECK(counted(2) == std::vector<int>{1});  // the coarsest
  CHECK(counted(1).empty());
  CHECK(effort_of({.level = 1, .levels = 3}).passes > effort_of({.level = 1, .levels = 4}).passes);
}

TEST_CASE("effort belongs to the coarse levels, and grows with quality") {
  for (int level = 0; level < 6; level++) {
    CAPTURE(level);
    LevelFacts facts{.level = level, .levels = 6};
    facts.quality = Quality::draft;
    const int draft = effort_of(facts).passes;
    facts.quality = Quality::normal;
    const int normal = effort_of(facts).passes;
    facts.quality = Quality::best;
    const int best = effort_of(facts).passes;
    CHECK(draft <= normal);
    CHECK(normal < best);
    if (level > 0) {
      facts.level = level - 1;
      CHECK(effort_of(facts).passes <= best);
    }
  }
}

}  // namespace terrazzo
