#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "runner/farm/assignment.h"
#include "runner/farm/farm_job.h"
#include "runner/scheduler/slurm.h"

/// How far a job is: found out each time, from the cache and the queue.
namespace terrazzo {

enum class UnitState : uint8_t {
  done,      ///< its results are there, verified by digest
  unneeded,  ///< not there, and nobody needs it any more
  running,
  waiting,    ///< in the queue
  failed,     ///< its last task says why
  lost,       ///< neither done nor in Slurm's queue, and nobody knows why: handed over again, it will be made
  elsewhere,  ///< another scheduler is to make it, which may not have begun
  cancelled,
};

std::string_view name_of(UnitState state);

struct JobState {
  Assignment assignment;
  std::vector<UnitState> units;                 ///< as in FarmJob::units
  std::map<std::string, std::string> failures;  ///< by unit: why
  std::map<std::string, QueuedTask> tasks;      ///< by unit, of those in the queue
  int left_out = 0;                             ///< nodes that are not in the job, see FarmJob::left_out

  int count(UnitState state) const;
  /// Whether there is all that the user asked for.
  bool is_complete() const {
    return left_out == 0 && count(UnitState::done) + count(UnitState::unneeded) == int(units.size());
  }
  /// Whether anything is still going to happen by itself.
  bool is_moving() const {
    return count(UnitState::running) + count(UnitState::waiting) + count(UnitState::elsewhere) > 0;
  }
};

/// `tasks`: what Slurm has of the job.
JobState state_of(const std::filesystem::path& folder, const FarmJob& job, const Plan& plan,
                  const std::vector<QueuedTask>& tasks);

/// The units of an array's tasks, by index; empty if it is not known, or its file is damaged. Throws FileError.
void write_array(const std::filesystem::path& folder, const TaskArray& array);
std::vector<std::vector<std::string>> read_array(const std::filesystem::path& folder, const std::string& id);

}  // namespace terrazzo
