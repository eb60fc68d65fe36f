#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "runner/farm/farm_job.h"

namespace terrazzo {

/// Runs units in processes of their own and looks after them: one that is killed is started again, what it cost is
/// remembered for the next job.
struct Supervision {
  std::vector<std::string> words;  ///< the program and the options that make one unit; job and unit are added
  std::filesystem::path costs;     ///< see runner/farm/costs.h
  uint64_t memory = 0;             ///< bytes that the scheduler gives; 0 if unknown
  const std::atomic<bool>* cancelled = nullptr;    ///< ends the process in order; may be null
  std::function<void(const std::string&)> told{};  ///< gets lines for people; may be empty
};

/// A process that is killed is started this often; more often it would hardly survive.
inline constexpr int attempts_of_a_unit = 3;

/// Makes the units one after another; one that fails ends none but those that need it. Returns the exit code: 0 if all
/// are made, else that of the last one that is not. Failures are noted in the job's folder.
int run_units(const std::filesystem::path& folder, const FarmJob& job, const std::vector<std::string>& units,
              const Supervision& how);

}  // namespace terrazzo
