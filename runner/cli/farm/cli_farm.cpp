#include "runner/cli/farm/cli_farm.h"

#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/base/text.h"

namespace terrazzo {

namespace {

using Json = nlohmann::ordered_json;

constexpr UnitState all_states[] = {UnitState::done,   UnitState::unneeded, UnitState::running,   UnitState::waiting,
                                    UnitState::failed, UnitState::lost,     UnitState::elsewhere, UnitState::cancelled};

}  // namespace

namespace {

/// Slurm's reasons for tasks that may wait forever; temporary reasons are left out.
std::set<std::string> obstacles(const JobState& state) {
  static const std::set<std::string> passing = {"",          "None",       "Priority", "Resources",
                                                "BeginTime", "Dependency", "Cleaning", "JobArrayTaskLimit"};
  std::set<std::string> reasons;
  for (const auto& [unit, task] : state.tasks)
    if (!task.is_running && !passing.contains(task.reason)) reasons.insert(task.reason);
  return reasons;
}

}  // namespace

std::string state_line(const JobState& state) {
  std::string line = fmt::format("{} of {} done", state.count(UnitState::done), state.units.size());
  for (const UnitState s : all_states)
    if (const int count = state.count(s); s != UnitState::done && count > 0)
      line += fmt::format(", {} {}", count, name_of(s));
  if (state.left_out > 0) line += fmt::format("; {} left out", counted(state.left_out, "node"));
  if (const std::set<std::string> reasons = obstacles(state); !reasons.empty())
    line += fmt::format("; Slurm does not start some of it: {}", fmt::join(reasons, ", "));
  return line;
}

std::string state_json(const std::filesystem::path& folder, const FarmJob& job, const JobState& state) {
  Json counts = Json::object(), units = Json::array(), left_out = Json::array();
  for (const UnitState s : all_states) counts[std::string(name_of(s))] = state.count(s);
  for (size_t i = 0; i < job.units.size(); i++) {
    const Unit& u = job.units[i];
    Json unit = {{"name", u.name}, {"state", name_of(state.units[i])}, {"needs", u.needs}, {"nodes", u.nodes}};
    if (const auto task = state.tasks.find(u.name); task != state.tasks.end()) unit["task"] = task->second.id;
    if (const auto failure = state.failures.find(u.name); failure != state.failures.end())
      unit["message"] = failure->second;
    units.push_back(std::move(unit));
  }
  for (const auto& [node, why] : job.left_out) left_out.push_back({{"node", node}, {"message", why}});
  const Json json = {{"job", job.name},
                     {"graph", job.graph},
                     {"folder", folder.string()},
                     {"complete", state.is_complete()},
                     {"moving", state.is_moving()},
                     {"counts", counts},
                     {"units", units},
                     {"left_out", left_out}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace terrazzo
