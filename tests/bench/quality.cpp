// Scores graphs/texture.json on many exemplars; tests/bench/quality builds and starts this.

#include <algorithm>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/picture/contact_sheet.h"
#include "tests/bench/quality_runs.h"

namespace fs = std::filesystem;
using namespace terrazzo;
using namespace terrazzo::bench;

namespace {

constexpr int sheet_side = 1600;

/// Rows by exemplar, then by tool.
using Scores = std::map<std::string, std::map<std::string, Row>>;

/// The tools whose results are in the folder of peers.
std::vector<std::string> tools_in(const fs::path& peers) {
  std::vector<std::string> tools;
  if (fs::is_directory(peers))
    for (const auto& entry : fs::directory_iterator(peers))
      if (entry.is_directory() && entry.path().filename() != "exemplars256") tools.push_back(entry.path().filename());
  std::sort(tools.begin(), tools.end());
  return tools;
}

fs::path peer_result(const fs::path& peers, const std::string& tool, const Case& c) {
  return peers / tool / (c.name + ".png");
}

void print_row(const std::string& name, const std::string& tool, const Row& row) {
  fmt::print("{:<38} {:<11}", name, tool);
  for (const Column& c : columns()) {
    const auto at = row.find(c.name);
    fmt::print(" {:>9}", at == row.end() ? "-" : fmt::format("{:.{}f}", at->second, c.decimals));
  }
  const auto seconds = row.find("seconds");
  fmt::print(" {:>7}\n", seconds == row.end() ? "-" : fmt::format("{:.2f}", seconds->second));
}

void print_means(const Scores& scores) {
  std::map<std::string, std::vector<const Row*>> by_tool;
  for (const auto& [name, tools] : scores)
    for (const auto& [tool, row] : tools) by_tool[tool].push_back(&row);
  for (const auto& [tool, rows] : by_tool) {
    Row mean;
    for (const Row* row : rows)
      for (const auto& [figure, value] : *row) mean[figure] += value / double(rows.size());
    print_row(fmt::format("mean of {}", rows.size()), tool, mean);
  }
}

/// The exemplar, what each peer made of it, and our result.
std::vector<ImagePtr> sheet_row(const Case& c, const Result& result, const fs::path& peers,
                                const std::vector<std::string>& tools) {
  std::vector<ImagePtr> row = {result.exemplar};
  for (const std::string& tool : tools) {
    const fs::path path = peer_result(peers, tool, c);
    row.push_back(fs::exists(path) ? read(path) : nullptr);
  }
  row.push_back(result.output);
  return row;
}

int score_all(const Program& program, const fs::path& exemplars, const fs::path& out,
              const std::vector<std::string>& only) {
  constexpr int seed = 1;
  const fs::path peers = exemplars / "../peers";
  std::vector<Case> cases = find_cases(program, exemplars, peers, out);
  if (!only.empty())
    std::erase_if(cases, [&](const Case& c) { return std::find(only.begin(), only.end(), c.name) == only.end(); });
  if (cases.empty()) throw Error(fmt::format("none of these exemplars is in {}", exemplars.string()));
  const std::vector<std::string> tools = tools_in(peers);

  fmt::print("{:<38} {:<11}", "exemplar", "tool");
  for (const Column& c : columns()) fmt::print(" {:>9}", c.name);
  fmt::print(" {:>7}\n", "seconds");
  Scores scores;
  std::vector<std::vector<ImagePtr>> sheet;
  int failures = 0;
  for (const Case& c : cases) {
    try {
      const Result result = synthesize(c, program, seed, out / "results" / c.name);
      for (const std::string& tool : tools)
        if (const fs::path path = peer_result(peers, tool, c); fs::exists(path))
          scores[c.name][tool] = scored(result.exemplar, read(path));
      scores[c.name]["terrazzo"] = result.row;
      for (const auto& [tool, row] : scores[c.name]) print_row(c.name, tool, row);
      std::fflush(stdout);
      sheet.push_back(sheet_row(c, result, peers, tools));
      write(contact_sheet({sheet.back()}, 2 * sheet_side), out / "sheets" / (c.name + ".png"));
    } catch (const Error& e) {
      fmt::print(stderr, "{}: {}\n", c.name, e.what());
      failures++;
    }
  }
  print_means(scores);
  constexpr size_t rows_per_sheet = 6;
  for (size_t first = 0; first < sheet.size(); first += rows_per_sheet) {
    const std::vector<std::vector<ImagePtr>> rows(
        sheet.begin() + std::ptrdiff_t(first),
        sheet.begin() + std::ptrdiff_t(std::min(sheet.size(), first + rows_per_sheet)));
    write(contact_sheet(rows, sheet_side), out / fmt::format("sheet{}.png", first / rows_per_sheet + 1));
  }
  fmt::print(stderr, "contact sheets are in {}\n", out.string());
  return failures > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    fmt::print(stderr, "usage: terrazzo_quality PROGRAM SOURCE EXEMPLARS OUT [NAME]...\n");
    return 2;
  }
  try {
    return score_all({fs::absolute(argv[1]), argv[2]}, argv[3], argv[4], {argv + 5, argv + argc});
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
