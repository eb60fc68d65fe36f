#include <algorithm>
#include <cstdlib>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "test_paths.h"
#include "tests/golden/documents.h"
#include "tests/golden/verdict.h"

/// Results are those that were recorded, or the node's version says that they are others. The folder's files:
/// cases/*.json hold the cases, *.txt what came out of them; regenerate.sh records it anew.
using namespace terrazzo;
using namespace terrazzo::test;

namespace {

namespace fs = std::filesystem;

/// Puts the lines of the documents that have run into the files, in the order of the documents.
void record(const fs::path& folder, const std::map<std::string, std::vector<GoldenLine>>& fresh,
            const std::vector<std::string>& documents) {
  std::map<std::string, size_t> order;
  for (const std::string& group : golden_groups())
    for (const GoldenDocument& d : documents_of(group)) order.try_emplace(d.name, order.size());
  const auto document_of = [](const GoldenLine& l) { return l.name.substr(0, l.name.find('/')); };
  for (auto& [name, file] : read_golden_files(folder)) {
    GoldenFile out{library_versions(), {}};
    for (const GoldenLine& l : file.lines)
      if (order.count(document_of(l)) && std::count(documents.begin(), documents.end(), document_of(l)) == 0)
        out.lines.push_back(l);
    if (const auto more = fresh.find(name); more != fresh.end())
      out.lines.insert(out.lines.end(), more->second.begin(), more->second.end());
    std::stable_sort(out.lines.begin(), out.lines.end(), [&](const GoldenLine& a, const GoldenLine& b) {
      return order.at(document_of(a)) < order.at(document_of(b));
    });
    write_golden(folder / (name + ".txt"), out);
  }
}

/// Compares the group's results with the golden files, or records them where TERRAZZO_GOLDEN_RECORD says.
void check_group(const std::string& group) {
  const char* target = std::getenv("TERRAZZO_GOLDEN_RECORD");
  const fs::path folder = target ? fs::path(target) : fs::path(TERRAZZO_SOURCE_DIR) / "tests" / "golden";
  Verdict verdict(read_golden_files(folder), library_versions());
  const GoldenSession session;
  std::map<std::string, std::vector<GoldenLine>> fresh;
  std::vector<std::string> documents;
  for (const GoldenDocument& document : documents_of(group)) {
    documents.push_back(document.name);
    for (const GoldenCase& c : session.run(document)) {
      verdict.judge(c);
      std::vector<GoldenLine>& lines = fresh[c.file];
      lines.insert(lines.end(), c.lines.begin(), c.lines.end());
    }
  }
  if (target) return record(folder, fresh, documents);
  verdict.judge_leftovers(documents);
  for (const std::string& complaint : verdict.diagnostics()) FAIL_CHECK(complaint);
  if (verdict.followers() > 0)
    MESSAGE(verdict.followers() << " nodes more give other results because of what they are given.");
  const std::string recorded = read_golden(folder / "image.txt").libraries;
  if (recorded != library_versions())
    MESSAGE("Results were recorded with " << recorded << "; with " << library_versions()
                                          << " they are only compared within a tolerance.");
  CHECK(!fresh.empty());
}

}  // namespace

TEST_SUITE_BEGIN("golden");

TEST_CASE("golden results: sources, images, pictures") {
  check_group("image");
}
TEST_CASE("golden results: analysis") {
  check_group("analysis");
}
TEST_CASE("golden results: synthesis") {
  check_group("synthesis");
}
TEST_CASE("golden results: lattices and masonry") {
  check_group("masonry");
}
TEST_CASE("golden results: sinks and what reads their files") {
  check_group("sink");
}
TEST_CASE("golden results: stock graphs") {
  check_group("graphs");
}

TEST_SUITE_END();
