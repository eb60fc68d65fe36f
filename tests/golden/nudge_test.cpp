#include <cmath>
#include <cstdlib>
#include <optional>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/tuning.h"
#include "test_paths.h"
#include "tests/golden/verdict.h"

/// Do the golden results notice when a tuning constant changes a little? Run it when a step is new or golden cases are
/// taken away. A constant takes up to a minute or two, so it is skipped unless it is asked for, for all constants or
/// those whose names begin with a text:
///   TERRAZZO_NUDGE=seams. build/tests/terrazzo_tests --no-skip -tc="golden results notice*"
using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// The first case whose results are not those recorded, those where constants matter most first.
std::optional<std::string> first_difference() {
  static const std::map<std::string, GoldenFile> recorded =
      read_golden_files(std::filesystem::path(TERRAZZO_SOURCE_DIR) / "tests" / "golden");
  const GoldenSession session;
  for (const char* group : {"masonry", "synthesis", "analysis", "image", "sink", "graphs"}) {
    Verdict verdict(recorded, library_versions());
    for (const GoldenDocument& document : documents_of(group))
      for (const GoldenCase& c : session.run(document)) {
        verdict.judge(c);
        if (!verdict.diagnostics().empty()) return c.lines.front().name;
      }
  }
  return std::nullopt;
}

/// Both directions; whole numbers by one at least.
std::vector<double> nudged(const TuningConstant& constant) {
  const double usual = constant.number();
  if (!std::holds_alternative<int*>(constant.value)) return {usual * 1.25, usual * 0.8};
  const double step = std::max(1.0, std::round(std::abs(usual) / 4));
  return {usual + step, usual - step};
}

/// Which case noticed, or why none could.
std::optional<std::string> who_notices(const TuningConstant& constant) {
  const double usual = constant.number();
  std::optional<std::string> noticed;
  for (const double value : nudged(constant)) {
    try {
      override_tuning(constant.name, value);
      noticed = first_difference();
      if (noticed) noticed = fmt::format("{} at {}", *noticed, value);
    } catch (const Error& e) {
      noticed = e.what();
    }
    override_tuning(constant.name, usual);
    if (noticed) break;
  }
  return noticed;
}

}  // namespace

TEST_CASE("golden results notice nudged constants" * doctest::skip()) {
  const char* asked = std::getenv("TERRAZZO_NUDGE");
  const std::string prefix = asked ? asked : "";
  int tried = 0;
  for (const TuningConstant* constant : tuning_constants()) {
    if (!constant->name.starts_with(prefix) || constant->name.starts_with("test_")) continue;
    tried++;
    const auto noticed = who_notices(*constant);
    fmt::print("{} {} {}\n", noticed ? "noticed" : "SLIPPED", constant->name, noticed.value_or(""));
    std::fflush(stdout);
    CHECK_MESSAGE(noticed, constant->name << " is another and no golden result is");
  }
  CHECK_MESSAGE(tried > 0, "no constant's name begins with \"" << prefix << "\"");
}
