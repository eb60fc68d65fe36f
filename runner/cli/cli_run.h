#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "graphs/document/load.h"
#include "runner/engine/schedule.h"
#include "runner/report/progress.h"
#include "runner/terminal/checked_flag.h"
#include "runner/terminal/command.h"
#include "runner/terminal/limit_flags.h"
#include "runner/terminal/written_files.h"

namespace terrazzo {

/// The options of every command that runs a graph.
struct RunFlags {
  std::string graph;  ///< the graph file; empty for a stock graph
  std::vector<std::string> only;
  std::string cache;
  std::string cache_size;
  bool no_cache = false;
  int threads = 0;
  LimitFlags limits;
  bool dry_run = false;
  bool watch = false;
  CheckedFlag checked;
  std::string report;
  std::string trace;
  std::string summary;
  bool keep_going = false;
  bool force = false;
  std::string sandbox;
  std::vector<std::string> files{};  ///< further files on the command line
  std::string progress = "auto";
  std::vector<WrittenFile> writes{};                ///< in addition to report and trace
  std::vector<ProtectedFile> reads{};               ///< in addition to the graph and its nodes' files
  std::map<std::string, std::string> variations{};  ///< see RunSummary
  std::vector<std::string> keep{};                  ///< further targets, whose values are kept for `after`
  /// Called before each load. The sandbox allows reading the returned folders.
  std::function<std::vector<std::filesystem::path>()> unpack{};
  std::function<void(const RunResult&)> after{};  ///< called with the result of each run

  /// Whether to use a cache.
  bool keeps() const { return !no_cache && !is_checked(); }
  bool is_checked() const { return checked.holds(cache); }
};

/// Prints the nodes' warnings.
void print_warnings(const RunResult& result);

void add_run_flags(Command& command, RunFlags& flags);

using LoadGraph = std::function<Graph(const LoadOptions&)>;

/// Runs the graph from `load`; returns the exit code. With `watch`, loads and runs it again whenever one of its files
/// changes. Throws UsageError and GraphError.
int run_with_flags(const LoadGraph& load, const RunFlags& flags);

}  // namespace terrazzo
