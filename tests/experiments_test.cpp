#include <fstream>
#include <set>
#include <string>

#include <doctest/doctest.h>

#include "core/base/tuning.h"
#include "test_paths.h"

namespace {

/// The headings of tests/bench/experiments.md.
std::set<std::string> sections() {
  std::set<std::string> found;
  std::ifstream in(std::string(TERRAZZO_SOURCE_DIR) + "/tests/bench/experiments.md");
  for (std::string line; std::getline(in, line);)
    if (line.rfind("## ", 0) == 0) found.insert(line.substr(3));
  return found;
}

}  // namespace

TEST_CASE("every tuning constant cites a section of tests/bench/experiments.md, or says that it was not measured") {
  const std::string unmeasured = "not measured: ";  // and why it is what it is
  const std::set<std::string> known = sections();
  REQUIRE(known.count("seams"));
  for (const terrazzo::TuningConstant* c : terrazzo::tuning_constants()) {
    if (c->name.rfind("test_", 0) == 0) continue;  // of another test
    CAPTURE(c->name);
    CAPTURE(c->measured);
    const bool says_why = c->measured.starts_with(unmeasured) && c->measured.size() > unmeasured.size();
    CHECK((says_why || known.count(c->measured)));
  }
}
