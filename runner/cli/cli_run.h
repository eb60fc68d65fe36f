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
  std::string progress = "auto";

  /// Whether to use a cache.
  bool keeps() const { return !no_cache && !is_checked(); }
  bool is_checked() const { return checked.holds(cache); }
};

/// A loaded graph, and what of it is to run.
struct GraphToRun {
  Graph graph;
  std::vector<std::string> only{};                  ///< empty: everything
  std::vector<std::string> keep{};                  ///< further targets, whose values are kept for CommandRun::after
  std::map<std::string, std::string> variations{};  ///< see RunSummary
};

/// What a command runs, and what it does besides.
struct CommandRun {
  std::function<GraphToRun(const LoadOptions&)> load{};
  std::string graph{};                 ///< the graph file; empty for a stock graph
  std::vector<ProtectedFile> reads{};  ///< in addition to the nodes' files
  std::vector<WrittenFile> writes{};   ///< in addition to those of the options
  std::vector<std::string> files{};    ///< further files on the command line, which a sandbox opens
  /// Called before each load. The sandbox allows reading the returned folders.
  std::function<std::vector<std::filesystem::path>()> unpack{};
  std::function<void(const RunResult&)> after{};  ///< called with the result of each run
};

/// Prints the nodes' warnings.
void print_warnings(const RunResult& result);

void add_run_flags(Command& command, RunFlags& flags);

/// Loads and runs a graph; returns the exit code. With `watch`, does so again whenever one of its files changes. Throws
/// UsageError and GraphError.
int run_with_flags(const CommandRun& run, const RunFlags& flags);

}  // namespace terrazzo
