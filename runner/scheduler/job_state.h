#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "runner/farm/assignment.h"
#include "runner/farm/farm_job.h"
#include "runner/scheduler/slurm.h"

/// The state of a job, determined anew each time from the cache and the queue.
namespace terrazzo {

enum class UnitState : uint8_t {
  done,      ///< its results exist, verified by digest
  unneeded,  ///< not done, and no longer needed
  running,
  waiting,    ///< in the queue
  failed,     ///< its last task recorded the reason
  lost,       ///< neither done nor in Slurm's queue, for an unknown reason; resubmit it
  elsewhere,  ///< assigned to another scheduler, which may not have started it
  cancelled,
};

std::string_view name_of(UnitState state);

struct JobState {
  Assignment assignment;
  std::vector<UnitState> units;                 ///< as in FarmJob::units
  std::map<std::string, std::string> failures;  ///< reasons by unit
  std::map<std::string, QueuedTask> tasks;      ///< queued tasks by unit
  int left_out = 0;                             ///< number of nodes missing from the job, see FarmJob::left_out

  int count(UnitState state) const;
  /// Whether all requested results exist.
  bool is_complete() const {
    return left_out == 0 && count(UnitState::done) + count(UnitState::unneeded) == int(units.size());
  }
  /// Whether the state can still change without a resubmission.
  bool is_moving() const {
    return count(UnitState::running) + count(UnitState::waiting) + count(UnitState::elsewhere) > 0;
  }
};

/// `tasks`: the job's tasks in Slurm's queue.
JobState state_of(const std::filesystem::path& folder, const FarmJob& job, const Plan& plan,
                  const std::vector<QueuedTask>& tasks);

/// The units of an array's tasks, by index. Reading returns an empty list if the array is unknown or its file is
/// damaged. Throws FileError.
void write_array(const std::filesystem::path& folder, const TaskArray& array);
std::vector<std::vector<std::string>> read_array(const std::filesystem::path& folder, const std::string& id);

}  // namespace terrazzo
