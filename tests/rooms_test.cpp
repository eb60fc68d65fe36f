#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "test_paths.h"

namespace {

namespace fs = std::filesystem;

const fs::path source = TERRAZZO_SOURCE_DIR;

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// tests/rooms.txt: the order in which rooms may include one another, each from those above it.
std::vector<std::string> rooms() {
  std::vector<std::string> names;
  std::istringstream lines(text_of(source / "tests/rooms.txt"));
  for (std::string line; std::getline(lines, line);) names.push_back(line.substr(0, line.find('\t')));
  return names;
}

std::vector<fs::path> sources(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(source / folder))
    if (const fs::path e = entry.path().extension(); e == ".cpp" || e == ".h")
      files.push_back(fs::relative(entry.path(), source));
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) found.push_back((*at)[1]);
  return found;
}

}  // namespace

TEST_CASE("includes between rooms follow the order of tests/rooms.txt") {
  const std::vector<std::string> order = rooms();
  const std::regex include(R"re(#include "([^"]+)/[^"/]+")re");
  const auto place = [&](const std::string& room) {
    return std::find(order.begin(), order.end(), room) - order.begin();
  };
  for (const char* folder : {"core", "nodes", "graphs", "runner"})
    for (const fs::path& file : sources(folder)) {
      const std::string room = file.parent_path().string();
      CAPTURE(file.string());
      REQUIRE_MESSAGE(place(room) < ptrdiff_t(order.size()), "this folder is not a room of tests/rooms.txt");
      for (const std::string& included : matches(text_of(source / file), include)) {
        CHECK_MESSAGE(place(included) <= place(room), "includes ", included, ", which comes after ", room);
      }
    }
}

TEST_CASE("core knows neither JSON nor the command line") {
  const std::regex forbidden(R"(#include <((?:nlohmann|CLI)/[^>]+)>)");
  for (const fs::path& file : sources("core")) {
    CAPTURE(file.string());
    CHECK(matches(text_of(source / file), forbidden).empty());
  }
}

TEST_CASE("Eigen is included through core/numeric, which settles how it computes") {
  const std::regex include(R"(#include <(Eigen/[^>]+)>)");
  for (const char* folder : {"core", "nodes", "graphs", "runner", "tests"})
    for (const fs::path& file : sources(folder)) {
      if (file == "core/numeric/eigen.h" || file == "core/numeric/linear_algebra.cpp") continue;
      CAPTURE(file.string());
      CHECK(matches(text_of(source / file), include).empty());
    }
}

TEST_CASE("no result depends on the last bit of the C library's elementary functions") {
  const std::regex forbidden(
      R"(\b(std::(?:exp2?|expm1|pow|log|log2|log10|log1p|a?sinh?|a?cosh?|a?tanh?|atan2|cbrt|hypot|polar|norm|[lt]gamma|erf)\())");
  for (const char* folder : {"core", "nodes"})
    for (const fs::path& file : sources(folder)) {
      CAPTURE(file.string());
      CHECK(matches(text_of(source / file), forbidden).empty());
    }
}

TEST_CASE("every room of the list holds something") {
  for (const std::string& room : rooms()) {
    CAPTURE(room);
    CHECK(fs::is_directory(source / room));
  }
}
