#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
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

/// The types that a file defines with external linkage, with their namespaces. It goes by how clang-format sets code:
/// namespaces and their types begin lines, and a comment names the namespace that ends.
std::vector<std::string> types_of(const std::string& text) {
  const std::regex type(
      R"(^(?:template <.*> )?(?:class|struct|union|enum(?: class)?) (?:\[\[\w+\]\] )?(\w+(?:::\w+)*)[^;()]*\{.*)");
  std::vector<std::string> found, namespaces;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (line.starts_with("namespace ") && line.ends_with("{"))
      namespaces.push_back(line.substr(10, line.size() - 11));
    else if (line.starts_with("}  // namespace") && !namespaces.empty())
      namespaces.pop_back();
    else if (std::count(namespaces.begin(), namespaces.end(), "") == 0 && std::regex_match(line, match, type)) {
      std::string name;
      for (const std::string& space : namespaces) name += space.substr(0, space.find_last_not_of(' ') + 1) + "::";
      found.push_back(name + match[1].str());
    }
  }
  return found;
}

/// Which units each unit includes. A header and its source file are one unit, named by their path without extension.
using UnitIncludes = std::map<std::string, std::set<std::string>>;

UnitIncludes unit_includes() {
  const std::regex include(R"re(#include "([^"]+)\.h")re");
  UnitIncludes includes;
  for (const char* folder : {"core", "nodes", "graphs", "runner"})
    for (const fs::path& file : sources(folder)) {
      const std::string unit = fs::path(file).replace_extension().string();
      std::set<std::string>& included = includes[unit];
      for (std::string& other : matches(text_of(source / file), include))
        if (other != unit) included.insert(std::move(other));
    }
  return includes;
}

/// The strongly connected components of more than one unit (Tarjan, Depth-first search and linear graph algorithms,
/// 1972), each sorted.
class IncludeCircles {
 public:
  explicit IncludeCircles(const UnitIncludes& includes) : includes_(includes) {
    for (const auto& [unit, others] : includes)
      if (!order_.contains(unit)) visit(unit);
  }
  const std::set<std::vector<std::string>>& found() const { return found_; }

 private:
  /// The least number that is reached from the unit among those that are open.
  size_t visit(const std::string& unit) {
    const size_t number = order_.size(), begin = open_.size();
    size_t least = number;
    order_[unit] = number;
    open_.push_back(unit);
    if (const auto at = includes_.find(unit); at != includes_.end())
      for (const std::string& other : at->second) {
        if (!order_.contains(other))
          least = std::min(least, visit(other));
        else if (std::ranges::find(open_, other) != open_.end())
          least = std::min(least, order_[other]);
      }
    if (least < number) return least;
    std::vector<std::string> circle(open_.begin() + ptrdiff_t(begin), open_.end());
    open_.resize(begin);
    std::ranges::sort(circle);
    if (circle.size() > 1) found_.insert(std::move(circle));
    return least;
  }

  const UnitIncludes& includes_;
  std::map<std::string, size_t> order_;
  std::vector<std::string> open_;
  std::set<std::vector<std::string>> found_;
};

}  // namespace

TEST_CASE("types of one name are found, those of anonymous namespaces aside") {
  CHECK(types_of("namespace a {\n\nnamespace {\nstruct Own {\n};\n}  // namespace\n\nclass Shown : public B {\n};\n"
                 "struct Declared;\nstruct One { int x; };\nenum class Two : int { x };\n}  // namespace a\n") ==
        std::vector<std::string>{"a::Shown", "a::One", "a::Two"});
}

TEST_CASE("no two files define a type of one name: the linker would take either for both") {
  std::map<std::string, fs::path> seen;
  for (const char* folder : {"core", "nodes", "graphs", "runner"})
    for (const fs::path& file : sources(folder))
      for (const std::string& type : types_of(text_of(source / file))) {
        const auto [first, is_new] = seen.emplace(type, file);
        CHECK_MESSAGE(is_new, type, " is defined in ", first->second.string(), " and in ", file.string());
      }
  CHECK(seen.size() > 400);
}

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

TEST_CASE("circles of includes are found") {
  const UnitIncludes includes = {{"a", {"b"}}, {"b", {"c", "d"}}, {"c", {"a", "d"}}, {"d", {"e"}}, {"e", {}}};
  CHECK(IncludeCircles(includes).found() == std::set<std::vector<std::string>>{{"a", "b", "c"}});
  CHECK(IncludeCircles({{"a", {"b", "c"}}, {"b", {"c"}}}).found().empty());
}

TEST_CASE("no unit includes another that includes it") {
  const UnitIncludes includes = unit_includes();
  CHECK(includes.size() > 400);
  const IncludeCircles circles(includes);
  for (const std::vector<std::string>& circle : circles.found()) {
    std::string text;
    for (const std::string& unit : circle) {
      text += "\n  " + unit + " includes";
      for (const std::string& other : includes.at(unit))
        if (std::ranges::binary_search(circle, other)) text += " " + other;
    }
    FAIL_CHECK("a circle of includes:", text);
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
