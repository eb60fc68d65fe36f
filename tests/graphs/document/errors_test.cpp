#include <filesystem>
#include <sstream>

#include <doctest/doctest.h>

#include "test_paths.h"
#include "tests/graphs/document/fake_types.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

/// Overrides stand in comments of their own: // --set name=value
std::vector<std::string> overrides_in(const std::string& text) {
  constexpr std::string_view mark = "// --set ";
  std::vector<std::string> out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(mark)) out.push_back(line.substr(mark.size()));
  return out;
}

}  // namespace

TEST_CASE("every wrong document in tests/errors gives the message beside it") {
  const fs::path folder = fs::path(TERRAZZO_SOURCE_DIR) / "tests/errors";
  int documents = 0;
  for (const std::string& name : listing(folder)) {
    if (fs::path(name).extension() != ".json") continue;
    CAPTURE(name);
    documents++;
    const std::string text = read_text(folder / name);
    check_golden_message(folder / name, problems_of(text, overrides_in(text), "tests/errors/" + name),
                         folder / "README.md");
  }
  CHECK(documents >= 30);
}
