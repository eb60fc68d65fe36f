#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "graphs/text/graph.h"
#include "graphs/text/problem.h"

namespace terrazzo {

/// Confines the nodes of an untrusted graph to a folder: sources read and sinks write only there and at paths named on
/// the command line. Follows symbolic links. Checks are thread-safe.
class Sandbox {
 public:
  explicit Sandbox(std::filesystem::path folder);
  /// `advice`: what messages end with, on how to allow a path.
  Sandbox(std::filesystem::path folder, std::string advice);
  /// Allows another path from the command line: a file, or a folder with its content. For a pattern such as
  /// "scans/*.png" it allows the folder before it.
  void open(const std::filesystem::path& path);
  /// The same for reading only.
  void open_to_read(const std::filesystem::path& path);

  /// Throws Error if `verb` ("read", "write") is not allowed for the path.
  void check(const char* verb, const std::filesystem::path& path) const;
  /// The message of check, "may not read /etc/passwd: ..."; empty if allowed.
  std::string trouble_with(std::string_view verb, const std::filesystem::path& path) const;

 private:
  std::filesystem::path given_;
  std::string advice_;
  std::vector<std::filesystem::path> roots_, readable_;  ///< with links resolved
};

/// Problems for files outside the sandbox that nodes would read or write. Opens no files.
std::vector<Problem> sandbox_problems(const std::vector<GraphNode>& nodes, const Sandbox& sandbox);

}  // namespace terrazzo
