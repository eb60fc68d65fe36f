#pragma once

#include <memory>
#include <optional>
#include <ostream>
#include <string_view>

#include "runner/engine/schedule.h"

/// Progress and messages of a run.
namespace terrazzo {

enum class ProgressMode : uint8_t {
  automatic,  ///< bar on a terminal, else plain
  bar,        ///< one line that is redrawn; notes above it
  plain,      ///< a line per finished stage, and occasional ones for slow stages
  json,       ///< one object per line, see make_progress
  none,       ///< only warnings and errors
};
inline constexpr std::array<std::string_view, 5> progress_mode_names = {"auto", "bar", "plain", "json", "none"};
std::optional<ProgressMode> progress_mode_from(std::string_view name);

/// An observer that also reports the end of the run. Thread-safe.
class Progress : public RunObserver {
 public:
  /// A warning that is not about a node; call before closed.
  virtual void warned(const std::string& message) = 0;
  virtual void closed(const RunResult& result) = 0;
};

/// `terminal`: whether `out` is one; decides what automatic means. `out` must outlive it.
///
/// json writes these objects, one per line, each with "event":
///   error     "message"; "file", "line", "column" and "node" where they are known: a wrong command line, a wrong
///   graph,
///             or a trace or report that cannot be written; several at once
///   warning   "message": about the document or the cache, or "node" and what its results may lack
///   plan      "stages": [{"node", "type", "state", "key" (or null), "why"}]; states as in StageState
///   start     "node"
///   wait      "node": another process that shares the cache is computing it
///   progress  "node", "fraction" in [0, 1]; at most ten a second for each node
///   note      "node", "message"
///   done      "node", "seconds"
///   cached    "node": its result was there
///   failed    "node", "message"
///   skipped   "node", "because": the failed node that it needs (with --keep-going)
///   finished  "ok", "cancelled", "seconds", "cpu_seconds" and "peak_memory" (bytes) of the whole process,
///             "cached", "run", "failed", "skipped", "unfinished", "files": [path]; the run's last
///   watching  "files": how many; the run is over and waits for one of them to change
std::unique_ptr<Progress> make_progress(ProgressMode mode, std::ostream& out, bool terminal);

/// Writes a warning before there is an observer: an object or a line of text, by mode.
void write_warning(ProgressMode mode, std::ostream& out, const std::string& message);
/// The same for errors other than of running nodes; a GraphError gives an object or a line per problem.
void write_error(ProgressMode mode, std::ostream& out, const std::exception& error);
/// Reports that the run waits for one of `files` files to change.
void write_watching(ProgressMode mode, std::ostream& out, size_t files);

}  // namespace terrazzo
