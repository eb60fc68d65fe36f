#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>

#include "graphs/text/graph.h"

namespace terrazzo {

/// Watches the files that a graph depends on: the graph file and all files its nodes read. Not thread-safe.
class Watch {
 public:
  /// Starts to watch this graph's files.
  void look_at(const Graph& graph);
  /// Takes the files' present state as the baseline for changes.
  void look_again();
  /// Whether one of them has changed, appeared or disappeared.
  bool has_changed() const;
  /// Waits for a change; polls ten times a second. Returns false once `cancelled` is set.
  bool wait_for_change(const std::atomic<bool>& cancelled) const;
  /// Runs `work` and sets its flag `stop` as soon as a file changes or `cancelled` is set.
  void until_change(const std::atomic<bool>& cancelled,
                    const std::function<void(const std::atomic<bool>& stop)>& work) const;
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
