#include "runner/scheduler/job_state.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/file/atomic_file.h"
#include "core/file/file_io.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

fs::path array_file(const fs::path& folder, const std::string& id) {
  return folder / "arrays" / (id + ".json");
}

}  // namespace

std::string_view name_of(UnitState state) {
  constexpr std::string_view names[] = {"done",   "not needed", "running",   "waiting",
                                        "failed", "lost",       "elsewhere", "cancelled"};
  return names[size_t(state)];
}

int JobState::count(UnitState state) const {
  return int(std::ranges::count(units, state));
}

void write_array(const fs::path& folder, const TaskArray& array) {
  write_whole_file(array_file(folder, array.id().hex()), nlohmann::json(array.tasks).dump() + "\n");
}

std::vector<std::vector<std::string>> read_array(const fs::path& folder, const std::string& id) {
  try {
    TaskArray array;
    nlohmann::json::parse(read_file(array_file(folder, id))).get_to(array.tasks);
    if (array.id().hex() == id) return array.tasks;
    return {};
  } catch (const std::exception&) {
    return {};
  }
}

namespace {

/// The state of a due unit that is neither queued nor failed.
UnitState state_of_missing(Assignment::To to) {
  switch (to) {
    case Assignment::To::others:
      return UnitState::elsewhere;
    case Assignment::To::nobody:
      return UnitState::cancelled;
    case Assignment::To::slurm:
      break;
  }
  return UnitState::lost;
}

}  // namespace

JobState state_of(const fs::path& folder, const FarmJob& job, const Plan& plan, const std::vector<QueuedTask>& tasks) {
  JobState state;
  state.assignment = assignment_of(folder);
  state.left_out = int(job.left_out.size());
  std::map<std::string, std::vector<std::vector<std::string>>> arrays;
  for (const QueuedTask& t : tasks) {
    const auto [array, is_new] = arrays.try_emplace(t.array);
    if (is_new) array->second = read_array(folder, t.array);
    if (t.index < 0 || size_t(t.index) >= array->second.size()) continue;
    for (const std::string& unit : array->second[size_t(t.index)]) {
      const auto at = state.tasks.find(unit);
      if (at == state.tasks.end() || t.is_running) state.tasks[unit] = t;
    }
  }
  const std::vector<bool> is_due = due(job.units, plan);
  const std::set<std::string> made = made_nodes(plan);
  for (size_t i = 0; i < job.units.size(); i++) {
    const Unit& unit = job.units[i];
    const auto task = state.tasks.find(unit.name);
    const auto failure = is_due[i] ? failure_of(folder, unit.name) : std::nullopt;
    UnitState now = is_done(unit, made) ? UnitState::done : UnitState::unneeded;
    if (is_due[i]) {
      now = state_of_missing(state.assignment.to);
      if (failure)
        now = UnitState::failed;
      else if (task != state.tasks.end())
        now = task->second.is_running ? UnitState::running : UnitState::waiting;
    }
    if (now == UnitState::failed) state.failures.emplace(unit.name, failure->message);
    state.units.push_back(now);
  }
  return state;
}

}  // namespace terrazzo
