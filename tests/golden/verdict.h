#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/golden/documents.h"
#include "tests/golden/record.h"

namespace terrazzo::test {

/// Compares results with what is recorded and says what to do about differences, a sentence each. Nodes whose inputs
/// differ already are not to blame: they are only counted.
class Verdict {
 public:
  /// `libraries`: those that the results were made with. `recorded`: the golden files by name.
  Verdict(std::map<std::string, GoldenFile> recorded, std::string libraries);

  /// Cases in the order in which they ran, also from one document to the next.
  void judge(const GoldenCase& golden);
  /// Complains about lines recorded for the documents that no case has asked for.
  void judge_leftovers(const std::vector<std::string>& documents);

  const std::vector<std::string>& diagnostics() const { return complaints_; }
  int followers() const { return followers_; }  ///< nodes that differ, or may, because what they were given does

 private:
  bool differs(const GoldenFile& file, const GoldenLine& recorded, const GoldenLine& now, bool pixelwise) const;
  bool follows(const GoldenCase& golden) const;

  std::map<std::string, GoldenFile> recorded_;
  std::string libraries_;
  std::set<Wire> changed_;
  std::set<std::filesystem::path> changed_files_;
  std::map<std::string, std::set<std::pair<std::string, std::string>>> seen_;  // by file: name and port
  std::set<std::string> versions_said_;                                        // node types
  std::vector<std::string> complaints_;
  int followers_ = 0;
};

}  // namespace terrazzo::test
