#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runner/farm/farm_folder.h"
#include "runner/scheduler/job_state.h"

/// Submits graphs as tasks.
namespace terrazzo {

/// A job that has not been written yet.
struct PreparedJob {
  FrozenGraph graph;
  FarmJob job;
  std::filesystem::path folder;
  std::vector<bool> due;  ///< whether each of its units must run
};

/// Prepares a job for a plan. Writes nothing. `plugins`: files that tasks must load; `left_out`: see FarmJob.
PreparedJob prepared(const Plan& plan, Cache& cache, const std::vector<std::string>& plugins,
                     const std::map<std::string, std::string>& left_out = {});

/// Writes the missing or altered files of a job; equal names imply equal jobs. Returns the repaired files if the job
/// existed already. Throws FileError.
std::vector<std::filesystem::path> write_job(const PreparedJob& prepared, Cache& cache);

/// The current state of a job. Queries Slurm only if the job may be in its queue. Throws Error if the job is damaged or
/// Slurm fails.
JobState look_at_job(const std::filesystem::path& folder, const FarmJob& job, Cache& cache, const Slurm& slurm);

struct HandedOver {
  TaskArray array;
  std::string id;  ///< id of the batch job
};

/// Submits all due units that are not in Slurm's queue, including failed ones. Concurrent calls submit a job only once.
/// Does nothing if the job is not assigned to Slurm. Throws Error with Slurm's message.
std::vector<HandedOver> hand_over(const std::filesystem::path& folder, const FarmJob& job, Cache& cache,
                                  const Slurm& slurm, const ArrayOptions& arrays, const SlurmOptions& options);

/// Cancels a job's tasks, even if the job is damaged. They stay cancelled until the job is submitted again. Throws
/// Error with Slurm's message, and if tasks remain in the queue.
void cancel_job(const std::filesystem::path& folder, Cache& cache, const Slurm& slurm);

struct WaitOptions {
  int retries = 2;  ///< how often lost tasks are resubmitted
  std::chrono::milliseconds first_pause{1000}, longest_pause{15000};
  const std::atomic<bool>* cancelled = nullptr;    ///< ends waiting with Cancelled; the job continues
  std::function<void(const JobState&)> looked{};   ///< called with each new state
  std::function<void(const std::string&)> told{};  ///< receives messages for the user
};

/// Waits until the job's state is final. Calls `again` to resubmit lost tasks.
JobState wait_for(const std::filesystem::path& folder, const FarmJob& job, Cache& cache, const Slurm& slurm,
                  const std::function<void()>& again, const WaitOptions& options);

}  // namespace terrazzo
