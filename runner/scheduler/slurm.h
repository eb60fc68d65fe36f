#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "runner/scheduler/slurm_script.h"

/// An interface to Slurm's command-line tools. They do not inherit the users' variables for these tools (SBATCH_*,
/// SQUEUE_*, SCANCEL_*, SLURM_*, ...), except SLURM_CONF, SLURM_CONF_SERVER and SLURM_JWT: others could hide tasks,
/// override options of batch scripts, or prevent cancellation.
namespace terrazzo {

/// A task in Slurm's queue that has not ended.
struct QueuedTask {
  std::string id;     ///< "17_3"
  std::string array;  ///< TaskArray::id(), as hexadecimal digits
  int index = 0;
  bool is_running = false;
  bool is_ending = false;  ///< its node is cleaning up; counts as running
  std::string reason;      ///< why it waits, in Slurm's words, or the node that it runs on
  std::string user;
};

/// The set variables for sbatch that are not passed on; sorted.
std::vector<std::string> ignored_slurm_settings();

/// Queries and commands. If a controller has answered before and is now busy or restarting, retries for some minutes,
/// after a message to `told`. Gives up after a few seconds on a controller that has never answered. All functions throw
/// Error with Slurm's own message. Thread-safe.
class Slurm {
 public:
  /// `cancelled` may be null; once set, waiting ends with Cancelled.
  explicit Slurm(std::function<void(const std::string&)> told = {}, const std::atomic<bool>* cancelled = nullptr);

  /// The limits of a partition: its largest node, and the most tasks of an array. If Slurm cannot be reached, Slurm's
  /// default for the latter, and unknown nodes.
  FarmLimits limits(const SlurmOptions& options) const;
  /// The tasks of a job that have not ended.
  std::vector<QueuedTask> queued(const std::string& job) const;
  /// Submits a script and returns the id of the batch job. If the controller's answer is lost, checks the queue, so
  /// that nothing is submitted twice.
  std::string submit(const std::filesystem::path& script, const std::string& job, const std::string& array) const;
  /// Cancels all tasks of a job. Throws Error that names the tasks still in the queue after some seconds.
  void cancel(const std::string& job) const;

 private:
  int max_array_size() const;
  std::string why_unreachable() const;
  void require_reachable() const;
  void pause(std::chrono::milliseconds time) const;
  std::string ask(const std::vector<std::string>& words,
                  const std::function<std::string()>& is_done_already = {}) const;

  std::function<void(const std::string&)> told_;
  const std::atomic<bool>* cancelled_;
  mutable std::atomic<bool> has_answered_ = false;
};

}  // namespace terrazzo
