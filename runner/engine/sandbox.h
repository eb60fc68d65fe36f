#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "graphs/text/graph.h"
#include "graphs/text/problem.h"

namespace terrazzo {

/// Keeps the nodes of a graph that one does not trust in a folder: sources read and sinks write only there, and in what
/// was named on the command line. Paths count as where they lead: links are followed.
class Sandbox {
 public:
  explicit Sandbox(std::filesystem::path folder);
  /// Opens another file, or folder with all that is in it: one that the command line names. Of a pattern such as
  /// "scans/*.png" it opens the folder in front.
  void open(const std::filesystem::path& path);
  /// The same, but nothing may be written there.
  void open_to_read(const std::filesystem::path& path);

  const std::filesystem::path& folder() const { return given_; }
  bool allows(const std::filesystem::path& path) const;
  /// Throws Error if it does not allow to `verb` ("read", "write") that.
  void check(const char* verb, const std::filesystem::path& path) const;
  /// "cannot read /etc/passwd: ..."; empty if that is allowed.
  std::string trouble_with(const char* verb, const std::filesystem::path& path) const;

 private:
  std::filesystem::path given_;
  std::vector<std::filesystem::path> roots_, readable_;  ///< where they lead
};

/// What the graph's nodes would read and write elsewhere. Opens nothing.
std::vector<Problem> sandbox_problems(const std::vector<GraphNode>& nodes, const Sandbox& sandbox);

}  // namespace terrazzo
