#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>

#include "runner/engine/schedule.h"
#include "runner/farm/farm_job.h"

namespace terrazzo {

struct UnitRunOptions {
  std::filesystem::path cache;                   ///< its folder
  int threads = 0;                               ///< 0: one per core
  uint64_t memory = 0;                           ///< budget in bytes; 0: the process's, see memory_budget
  const std::atomic<bool>* cancelled = nullptr;  ///< may be null
  RunObserver* observer = nullptr;               ///< likewise
  /// How long to wait for another machine's results to become visible on a network file system. After that they are
  /// recomputed, with the same result.
  std::chrono::milliseconds patience{6000};
};

/// The result of running a unit.
struct UnitResult {
  RunResult run;
  std::map<std::string, StageRecord> made{};  ///< by target: opened and verified after the run
};

/// The key of a node without its inputs, which is stored in a job. Known for every node before anything runs.
Digest key_on_farm(const GraphNode& node, Cache& cache);

/// Runs one unit of a job in this process. Throws Error if the document or an input of the unit has changed since
/// freezing, if a node's key differs (another version, plug-in or colour configuration), if a unit that it needs has
/// failed, or if a result cannot be read back. Errors of nodes are in the result.
UnitResult run_unit(const std::filesystem::path& folder, const FarmJob& job, const Unit& unit,
                    const UnitRunOptions& options);

}  // namespace terrazzo
