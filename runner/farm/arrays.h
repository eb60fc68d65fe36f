#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/farm/units.h"

/// Groups units into arrays of tasks, which a scheduler accepts as one submission.
namespace terrazzo {

/// The limits of a scheduler.
struct FarmLimits {
  int tasks = 1000;  ///< the most tasks of one array
  /// Of its largest machine; 0: unknown. Estimates stay below these.
  int cores = 0;
  uint64_t memory = 0;  ///< bytes
};

struct ArrayOptions {
  FarmLimits limits{};
  double pack_seconds = 60;  ///< units are packed into one task up to about this duration
  int cores = 0;             ///< per task; 0: as earlier units of the kind used, else `usual_cores`
  uint64_t memory = 0;       ///< bytes; 0: likewise
};

/// Defaults for kinds of units that have not run yet. They trade waiting in the queue against a slower first run.
inline constexpr int usual_cores = 2;
/// The most cores that are requested because earlier units used them: more would make a task wait for a whole machine.
inline constexpr int most_usual_cores = 16;
inline constexpr uint64_t usual_memory = uint64_t{2} << 30;

/// Tasks with similar costs that can run concurrently.
struct TaskArray {
  std::string label{};                            ///< for people: "layout", or "layout and 63 more"
  std::vector<std::vector<std::string>> tasks{};  ///< by index: the units of a task, in order of execution
  std::vector<size_t> needs{};                    ///< arrays that must end first; all have smaller indices
  int cores = 1;
  uint64_t memory = 0;  ///< bytes
  double seconds = 0;   ///< expected duration of the longest task

  /// Identifies the units in it, by task.
  Digest id() const;
};

/// Groups the due units into arrays, ordered by their needs. `failed_memory`: by unit, the bytes that were too few when
/// it was killed.
std::vector<TaskArray> arrays_of(const std::vector<Unit>& units, const std::vector<bool>& due,
                                 const std::filesystem::path& costs,
                                 const std::map<std::string, uint64_t>& failed_memory, const ArrayOptions& options);

}  // namespace terrazzo
