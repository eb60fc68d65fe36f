#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/farm/units.h"

/// Units as arrays of tasks, which a scheduler takes at once.
namespace terrazzo {

/// What a scheduler can give.
struct FarmLimits {
  int tasks = 1000;  ///< of one array
  /// Of its largest machine; 0: not known. Guesses stay below these.
  int cores = 0;
  uint64_t memory = 0;  ///< bytes
};

struct ArrayOptions {
  FarmLimits limits{};
  double pack_seconds = 60;  ///< units are put into one task until it takes about this long
  int cores = 0;             ///< for each task; 0: as units of the kind have used, else `usual_cores`
  uint64_t memory = 0;       ///< bytes, likewise
};

/// For units of a kind that has not run yet. Trades waiting in the queue against a slower first run.
inline constexpr int usual_cores = 2;
/// However many earlier units have used: more make a task wait for a whole machine.
inline constexpr int most_usual_cores = 16;
inline constexpr uint64_t usual_memory = uint64_t{2} << 30;

/// Tasks that cost about the same and can run at the same time.
struct TaskArray {
  std::string label{};                            ///< for people: "layout", or "layout and 63 more"
  std::vector<std::vector<std::string>> tasks{};  ///< by index, the units that a task makes, in this order
  std::vector<size_t> needs{};                    ///< arrays that come before it, all of them earlier ones
  int cores = 1;
  uint64_t memory = 0;  ///< bytes
  double seconds = 0;   ///< that the longest task is expected to take

  /// Of the units in it, by task.
  Digest id() const;
};

/// The units that are due, in arrays. `failed_memory`: by unit, bytes that were too few when it was killed. An array's
/// needs come before it.
std::vector<TaskArray> arrays_of(const std::vector<Unit>& units, const std::vector<bool>& due,
                                 const std::filesystem::path& costs,
                                 const std::map<std::string, uint64_t>& failed_memory, const ArrayOptions& options);

}  // namespace terrazzo
