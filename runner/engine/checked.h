#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "runner/plan/plan.h"

/// Checked runs prove what the cache trusts: that a node's results depend on nothing but its key. Each node is run
/// twice and must give the same, to the last pixel; and what it opens and which variables of the environment it reads
/// is watched, where the watching library was loaded before all others (see start_watching).
namespace terrazzo {

/// Whether files and variables are watched in this process.
bool is_watching();

/// Starts the program anew, with the watching library loaded before all others. Returns if it cannot, or need not.
void start_watching(const char* const* argv);
/// Why start_watching could not; empty if it did.
std::string why_not_watching();

/// A file is being opened, with the flags of open(2): for what opens files on behalf of nodes and is not watched
/// otherwise, such as Python.
void tell_opened(const char* path, int flags);

/// What the process reads while it lives. One at a time: others wait. The thread that makes it ends it.
class WatchedReads {
 public:
  WatchedReads();
  ~WatchedReads();
  WatchedReads(const WatchedReads&) = delete;
  WatchedReads& operator=(const WatchedReads&) = delete;
  void stop();
  const std::set<std::filesystem::path>& files() const { return files_; }  ///< opened for reading
  const std::set<std::string>& variables() const { return variables_; }

 private:
  friend struct WatchedSink;
  std::set<std::filesystem::path> files_;
  std::set<std::string> variables_;
};

/// Runs the node a second time, with `again`, a copy of its context from before the first. Throws Error if it gives
/// another output, stages other files, or has read what its key does not cover.
void check_node(const Stage& stage, const NodeContext& first, NodeContext& again, const WatchedReads& reads);

}  // namespace terrazzo
