#pragma once

#include <atomic>
#include <filesystem>
#include <map>

#include "graphs/document/graph.h"

namespace terrazzo {

/// The files that a graph depends on: the graph file and everything its nodes read.
class Watch {
 public:
  /// Starts to watch this graph's files.
  void look_at(const Graph& graph);
  /// Takes the files as they are now: only what changes from here on counts.
  void look_again();
  /// Waits until one of them changes, appears or disappears; polls twice a second. False once `cancelled` is set.
  bool wait_for_change(const std::atomic<bool>& cancelled);
  size_t count() const { return seen_.size(); }

 private:
  struct Look {
    std::filesystem::file_time_type time;
    uintmax_t size = 0;
    bool operator==(const Look&) const = default;
  };
  static Look look(const std::filesystem::path& path);
  std::map<std::filesystem::path, Look> seen_;
};

}  // namespace terrazzo
