#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/golden/content.h"

/// The golden files: one line for every output of every case.
namespace terrazzo::test {

/// What was, or is to be, recorded of one output.
struct GoldenLine {
  std::string name;  ///< document/node
  std::string type;
  int version = 0;
  std::string port;  ///< or, of a sink, the file
  Content content;
};

/// A file of the golden folder.
struct GoldenFile {
  std::string libraries;  ///< those that the results were recorded with
  std::vector<GoldenLine> lines;

  /// Null if there is none.
  const GoldenLine* find(const std::string& name, const std::string& port) const;
};

/// Throws Error naming file and line if it is damaged; a file that does not exist has no lines.
GoldenFile read_golden(const std::filesystem::path& path);
/// All golden files of a folder by name, without their endings.
std::map<std::string, GoldenFile> read_golden_files(const std::filesystem::path& folder);
void write_golden(const std::filesystem::path& path, const GoldenFile& file);

/// Whether two contents are nearly the same, as far as their figures tell. `pixelwise`: also at each sample; not to be
/// asked of results of decisions, which may differ as a whole when an input changes a little.
bool nearly_same(const Content& a, const Content& b, bool pixelwise);

}  // namespace terrazzo::test
