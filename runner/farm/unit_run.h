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
  /// What another machine has just made may not be seen yet on a network file system: how long to look for it. After
  /// that it is made again, which gives the same.
  std::chrono::milliseconds patience{6000};
};

/// What a unit has made.
struct UnitResult {
  RunResult run;
  std::map<std::string, StageRecord> made{};  ///< by target: opened and verified after the run
};

/// The key of a node without what its wires bring, with which a job is frozen: known of every node, whatever has run.
Digest key_on_farm(const GraphNode& node, Cache& cache);

/// Makes one unit of a job in this process. Throws Error if the job's document or an input behind the unit is not what
/// was frozen, if a node's key is not the one that it had then (another version, plug-in or colour configuration), if a
/// unit that it needs has failed, and if what was made cannot be read back; what nodes say is in the result.
UnitResult run_unit(const std::filesystem::path& folder, const FarmJob& job, const Unit& unit,
                    const UnitRunOptions& options);

}  // namespace terrazzo
