#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "runner/farm/farm_job.h"

namespace terrazzo {

/// Runs units in child processes: restarts killed ones, and records costs for later jobs.
struct Supervision {
  std::vector<std::string> words;                  ///< the command that runs a unit; job and unit are appended
  std::filesystem::path costs;                     ///< see runner/farm/costs.h
  uint64_t memory = 0;                             ///< the scheduler's memory limit in bytes; 0 if unknown
  const std::atomic<bool>* cancelled = nullptr;    ///< stops the child process gracefully; may be null
  std::function<void(const std::string&)> told{};  ///< receives messages for the user; may be empty
};

/// How often a killed process is started at most; further attempts would hardly succeed.
inline constexpr int attempts_of_a_unit = 3;

/// Runs the units one after another. A failure skips only the units that need it. Returns the exit code: 0 if all
/// succeed, else that of the last failed unit. Records failures in the job's folder.
int run_units(const std::filesystem::path& folder, const FarmJob& job, const std::vector<std::string>& units,
              const Supervision& how);

}  // namespace terrazzo
