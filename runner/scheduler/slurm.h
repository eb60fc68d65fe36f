#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "runner/scheduler/slurm_script.h"

/// Slurm, by its command-line tools. These get none of the variables with which users set up their own calls of them
/// (SBATCH_*, SQUEUE_*, SCANCEL_*, SLURM_*, ...), but for SLURM_CONF, SLURM_CONF_SERVER and SLURM_JWT: others would
/// hide tasks, beat what a batch script asks for, or keep tasks from being ended.
namespace terrazzo {

/// A task that Slurm knows and that has not ended.
struct QueuedTask {
  std::string id;     ///< "17_3"
  std::string array;  ///< TaskArray::id(), as hexadecimal digits
  int index = 0;
  bool is_running = false;
  bool is_ending = false;  ///< its node is cleaning up; counts as running
  std::string reason;      ///< why it waits, in Slurm's words; or the node that it runs on
  std::string user;
};

/// The variables with which a user asks sbatch for something, and which it does not get; sorted.
std::vector<std::string> ignored_slurm_settings();

/// What is asked of Slurm. A controller that has answered before, and is now busy or being restarted, is asked again
/// for some minutes; `told` gets a line for people when that begins. One that cannot be reached at all is given up
/// after a few seconds. All functions throw Error with Slurm's own message. Thread-safe.
class Slurm {
 public:
  /// `cancelled` ends waiting early, with Cancelled; may be null.
  explicit Slurm(std::function<void(const std::string&)> told = {}, const std::atomic<bool>* cancelled = nullptr);

  /// What a partition can give: the largest of its nodes, and how many tasks an array may have. If Slurm cannot be
  /// reached, the default of its configuration for the latter, and nothing about nodes.
  FarmLimits limits(const SlurmOptions& options) const;
  /// The tasks of a job that have not ended.
  std::vector<QueuedTask> queued(const std::string& job) const;
  /// Hands a script over; returns the id of the batch job. If the controller's answer is lost, the queue tells whether
  /// it has been taken, so that it is never handed over twice.
  std::string submit(const std::filesystem::path& script, const std::string& job, const std::string& array) const;
  /// Ends all tasks of a job. Throws Error that names those which are still in the queue after some seconds.
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
