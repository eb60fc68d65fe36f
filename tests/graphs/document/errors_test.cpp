#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "test_paths.h"
#include "tests/graphs/document/fake_types.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

std::string text_of_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Overrides stand in comments of their own: // --set name=value
std::vector<std::string> overrides_in(const std::string& text) {
  constexpr std::string_view mark = "// --set ";
  std::vector<std::string> out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(mark)) out.push_back(line.substr(mark.size()));
  return out;
}

std::vector<fs::path> wrong_documents() {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(fs::path(TERRAZZO_SOURCE_DIR) / "tests/errors"))
    if (entry.path().extension() == ".json") out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

TEST_CASE("every wrong document in tests/errors gives the message beside it") {
  const bool update = std::getenv("TERRAZZO_UPDATE_GOLDEN") != nullptr;
  const std::string list = text_of_file(fs::path(TERRAZZO_SOURCE_DIR) / "tests/errors/README.md");
  const std::vector<fs::path> documents = wrong_documents();
  CHECK(documents.size() >= 30);
  for (const fs::path& path : documents) {
    const std::string name = path.filename().string();
    CAPTURE(name);
    const std::string text = text_of_file(path);
    const std::string found = problems_of(text, overrides_in(text), "tests/errors/" + name) + "\n";
    const fs::path golden = fs::path(path).replace_extension(".txt");
    if (update) std::ofstream(golden, std::ios::binary) << found;
    CHECK(found != "\n");
    CHECK(found == text_of_file(golden));
    CHECK_MESSAGE(list.find(fmt::format("`{}`", path.stem().string())) != list.npos,
                  "not listed in tests/errors/README.md");
  }
}
