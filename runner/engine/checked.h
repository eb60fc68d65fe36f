#pragma once

#include <filesystem>
#include <mutex>
#include <set>
#include <string>

#include "runner/plan/plan.h"

/// Checked runs test the assumption of the cache: a node's results depend only on its key. Each node runs twice and
/// must give the same results, to the last pixel. If the watch library is preloaded (see start_watching), the files
/// that nodes open and the environment variables they read are also checked.
namespace terrazzo {

/// Whether files and variables are watched in this process.
bool is_watching();

/// Restarts the program with the watch library preloaded. Returns if that is impossible or unnecessary.
void start_watching(const char* const* argv);
/// Why start_watching failed; empty if it succeeded.
std::string why_not_watching();

/// Reports that a file is being opened, with the flags of open(2). For code that opens files for nodes unwatched, such
/// as Python.
void tell_opened(const char* path, int flags);

/// Records what the process reads while the object lives. Only one object exists at a time: further constructors wait.
/// The thread that creates it must destroy it.
class WatchedReads {
 public:
  WatchedReads();
  ~WatchedReads() { stop(); }
  WatchedReads(const WatchedReads&) = delete;
  WatchedReads& operator=(const WatchedReads&) = delete;
  void stop();
  const std::set<std::filesystem::path>& files() const { return files_; }  ///< opened for reading
  const std::set<std::string>& variables() const { return variables_; }

 private:
  friend void tell_opened(const char* path, int flags);
  /// `by`: an address in the code that opens the file ('f') or reads the variable ('v').
  static void tell(char kind, const char* what, int flags, const void* by);

  std::unique_lock<std::mutex> turn_;
  std::set<std::filesystem::path> files_;
  std::set<std::string> variables_;
};

/// Runs the node a second time, with `again`, a copy of its context from before the first run. Throws Error if outputs
/// or staged files differ, or if the node has read something that its key does not cover.
void check_node(const Stage& stage, NodeContext& first, NodeContext& again, const WatchedReads& reads);

}  // namespace terrazzo
