#include "runner/farm/arrays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>

#include "runner/farm/costs.h"

namespace terrazzo {

namespace {

/// The expected resources of a unit.
struct Demand {
  double seconds = 0;
  int cores = 0;
  uint64_t memory = 0;
  auto operator<=>(const Demand&) const = default;
};

/// Rounded up, so that units of one kind request the same resources even if one was measured later.
uint64_t rounded(uint64_t bytes) {
  constexpr uint64_t step = uint64_t{64} << 20;
  return (bytes + step - 1) / step * step;
}

/// The most that tasks get without an explicit setting.
struct Ceiling {
  int cores;
  uint64_t memory;
};

Ceiling ceiling_of(const FarmLimits& limits) {
  return {limits.cores > 0 ? std::min(limits.cores, most_usual_cores) : most_usual_cores,
          limits.memory > 0 ? limits.memory : std::numeric_limits<uint64_t>::max()};
}

Demand demand_of(const Unit& unit, const std::optional<UnitCost>& known, uint64_t failed_memory,
                 const ArrayOptions& options) {
  Demand d{unit.seconds, usual_cores, usual_memory};
  if (known) {
    // Headroom for other seeds; the measurement includes the process itself and its libraries.
    constexpr uint64_t a_little = uint64_t{128} << 20;
    d = {known->seconds, int(std::lround(known->cpu_seconds / std::max(known->seconds, 0.001))),
         rounded(known->memory + known->memory / 4 + a_little)};
  }
  const Ceiling ceiling = ceiling_of(options.limits);
  d.cores = options.cores > 0 ? options.cores : std::clamp(d.cores, 1, ceiling.cores);
  if (options.memory > 0) d.memory = options.memory;
  d.memory = std::min(std::max(d.memory, 2 * failed_memory), ceiling.memory);
  return d;
}

/// The length of the longest chain of units before each.
std::map<std::string, int> depths(const std::vector<Unit>& units, const std::vector<bool>& due) {
  std::map<std::string, int> out;
  for (size_t i = 0; i < units.size(); i++) {
    if (!due[i]) continue;
    int depth = 0;
    for (const std::string& n : units[i].needs)
      if (const auto at = out.find(n); at != out.end()) depth = std::max(depth, at->second + 1);
    out.emplace(units[i].name, depth);
  }
  return out;
}

}  // namespace

Digest TaskArray::id() const {
  Hasher h;
  h.add("array");
  for (const auto& task : tasks) {
    h.add(int64_t(task.size()));
    for (const std::string& unit : task) h.add(unit);
  }
  return h.digest();
}

std::vector<TaskArray> arrays_of(const std::vector<Unit>& units, const std::vector<bool>& due,
                                 const std::filesystem::path& costs,
                                 const std::map<std::string, uint64_t>& failed_memory, const ArrayOptions& options) {
  struct Group {
    Demand demand;
    std::vector<const Unit*> units;
  };
  const std::map<std::string, int> depth = depths(units, due);
  std::map<Digest, std::optional<UnitCost>> known;
  std::map<std::tuple<int, Digest, uint64_t>, Group> groups;  // ordered by depth in the chain of needs
  for (size_t i = 0; i < units.size(); i++) {
    if (!due[i]) continue;
    const Unit& unit = units[i];
    const auto [cost, is_new] = known.try_emplace(unit.kind);
    if (is_new) cost->second = cost_of(costs, unit.kind);
    const auto failed = failed_memory.find(unit.name);
    const uint64_t too_few = failed == failed_memory.end() ? 0 : failed->second;
    Group& group = groups[{depth.at(unit.name), unit.kind, too_few}];
    const Demand d = demand_of(unit, cost->second, too_few, options);
    group.demand = {std::max(group.demand.seconds, d.seconds), d.cores, d.memory};
    group.units.push_back(&unit);
  }

  std::vector<TaskArray> arrays;
  std::map<std::string, size_t> array_of;  // by unit
  for (const auto& [where, group] : groups) {
    const double each = std::max(group.demand.seconds, 0.05);  // at least the start of a process
    const auto per_task = size_t(std::max(1.0, std::floor(options.pack_seconds / each)));
    const size_t per_array = per_task * size_t(options.limits.tasks);
    for (size_t first = 0; first < group.units.size(); first += per_array) {
      const size_t end = std::min(group.units.size(), first + per_array);
      TaskArray array{.cores = group.demand.cores, .memory = group.demand.memory};
      array.label = group.units[first]->name;
      if (end - first > 1) array.label += fmt::format(" and {} more", end - first - 1);
      std::set<size_t> needs;
      for (size_t i = first; i < end; i++) {
        if ((i - first) % per_task == 0) array.tasks.emplace_back();
        array.tasks.back().push_back(group.units[i]->name);
        array_of.emplace(group.units[i]->name, arrays.size());
        for (const std::string& n : group.units[i]->needs)
          if (const auto at = array_of.find(n); at != array_of.end()) needs.insert(at->second);
      }
      array.seconds = each * double(std::min(per_task, end - first));
      array.needs.assign(needs.begin(), needs.end());
      arrays.push_back(std::move(array));
    }
  }
  return arrays;
}

}  // namespace terrazzo
