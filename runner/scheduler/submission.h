#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runner/farm/farm_folder.h"
#include "runner/scheduler/job_state.h"

/// From a graph to tasks in a queue.
namespace terrazzo {

/// A job that has been thought out and not yet written.
struct PreparedJob {
  FrozenGraph graph;
  FarmJob job;
  std::filesystem::path folder;
  std::vector<bool> due;  ///< which of its units have to be made
};

/// What a farm would do for a plan. Writes nothing. `plugins`: files that tasks must load; `left_out`: see FarmJob.
PreparedJob prepared(const Plan& plan, Cache& cache, const std::vector<std::string>& plugins,
                     const std::map<std::string, std::string>& left_out = {});

/// Writes the job, as far as it is not there already, unaltered: a job of this name is this job. Of one that was there,
/// returns the files that had to be mended. Throws FileError.
std::vector<std::filesystem::path> write_job(const PreparedJob& prepared, Cache& cache);

/// What is known of a job now. Slurm is asked only if the job may be in its queue. Throws Error if the job is damaged,
/// and with Slurm's message.
JobState look_at_job(const std::filesystem::path& folder, const FarmJob& job, Cache& cache, const Slurm& slurm);

struct HandedOver {
  TaskArray array;
  std::string id;  ///< of the batch job
};

/// Hands to Slurm what has to be made and is not in its queue, what failed too; a job that is handed over twice at the
/// same time is handed over once, and one that is not assigned to Slurm, not at all. Throws Error with Slurm's message.
std::vector<HandedOver> hand_over(const std::filesystem::path& folder, const FarmJob& job, Cache& cache,
                                  const Slurm& slurm, const ArrayOptions& arrays, const SlurmOptions& options);

/// Ends a job's tasks, even of one that is damaged; they are not handed over again until the job is submitted again.
/// Throws Error with Slurm's message, and if tasks stay in the queue.
void cancel_job(const std::filesystem::path& folder, Cache& cache, const Slurm& slurm);

struct WaitOptions {
  int retries = 2;  ///< how often tasks that got lost are handed over again
  std::chrono::milliseconds first_pause{1000}, longest_pause{15000};
  const std::atomic<bool>* cancelled = nullptr;    ///< ends waiting, with Cancelled; the job goes on
  std::function<void(const JobState&)> looked{};   ///< called with each new state
  std::function<void(const std::string&)> told{};  ///< gets lines for people
};

/// Waits until nothing will happen any more by itself; what got lost is handed over again by `again`.
JobState wait_for(const std::filesystem::path& folder, const FarmJob& job, Cache& cache, const Slurm& slurm,
                  const std::function<void()>& again, const WaitOptions& options);

}  // namespace terrazzo
