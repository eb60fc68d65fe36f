#include "runner/farm/units.h"

#include <algorithm>
#include <bit>
#include <map>
#include <set>

#include "runner/farm/time_guess.h"

namespace terrazzo {

namespace {

/// Earlier runs of the graph may have used smaller sizes.
double seconds_of(const Plan& plan, const Stage& stage) {
  return std::max(stage.expected_seconds, guessed_seconds(plan, stage));
}

/// Assigns units to each stage. Units are numbered by their last stage.
class Parting {
 public:
  explicit Parting(const Plan& plan)
      : plan_(plan), makers_(plan.stages.size()), branch_(plan.stages.size()), is_apart_(plan.stages.size()) {
    add_up_branches();
    for (int i = int(plan.stages.size()) - 1; i >= 0; i--)
      if (plan.stages[size_t(i)].needed) place(i);
  }

  const std::set<int>& makers(int stage) const { return makers_[size_t(stage)]; }

 private:
  const Stage& at(int stage) const { return plan_.stages[size_t(stage)]; }

  /// The time of each stage and of the stages computed only for it.
  void add_up_branches() {
    for (size_t i = 0; i < plan_.stages.size(); i++) {
      branch_[i] = seconds_of(plan_, at(int(i)));
      for (const int source : at(int(i)).sources)
        if (at(source).readers.size() == 1) branch_[i] += branch_[size_t(source)];
    }
  }

  void place(int stage) {
    std::set<int> makers;
    for (const int reader : at(stage).readers)
      makers.insert(makers_[size_t(reader)].begin(), makers_[size_t(reader)].end());
    const bool is_slow = at(stage).type().persist == Persist::payload;
    const bool is_shared = makers.size() > 1 || is_apart_[size_t(stage)];
    if (at(stage).target || makers.empty() || (is_slow && is_shared)) makers = {stage};
    part_branches(stage, is_apart_[size_t(stage)] && !makers.contains(stage));
    makers_[size_t(stage)] = std::move(makers);
  }

  /// Splits slow branches that could run concurrently.
  void part_branches(int stage, bool is_passed_on) {
    const auto is_slow = [&](int source) { return branch_[size_t(source)] >= seconds_worth_a_task; };
    const std::vector<int>& sources = at(stage).sources;
    if (!is_passed_on && std::ranges::count_if(sources, is_slow) < 2) return;
    for (const int source : sources)
      if (is_slow(source)) is_apart_[size_t(source)] = true;
  }

  const Plan& plan_;
  std::vector<std::set<int>> makers_;
  std::vector<double> branch_;
  std::vector<bool> is_apart_;
};

void add_costly(Hasher& h, const GraphNode& node) {
  h.add(node.type->name).add(node.type->version);
  for (const auto& [name, value] : node.params) {
    const Param* param = node.type->find_param(name);
    if (param && (param->type == ParamType::size || param->type == ParamType::choice)) add_to(h, {{name, value}});
  }
}

/// The amount of input of each stage, from its largest branch only, so that nothing counts twice.
std::vector<uint64_t> bytes_read(const Plan& plan) {
  std::vector<uint64_t> bytes(plan.stages.size());
  for (size_t i = 0; i < plan.stages.size(); i++) {
    const Stage& s = plan.stages[i];
    for (const int source : s.sources) bytes[i] = std::max(bytes[i], bytes[size_t(source)]);
    if (!s.needed || !s.type().files_read) continue;
    for (const auto& file : s.type().files_read(s.node->params)) {
      std::error_code missing;
      const uintmax_t size = std::filesystem::file_size(file, missing);
      if (!missing) bytes[i] += size;
    }
  }
  return bytes;
}

}  // namespace

std::vector<Unit> units_of(const Plan& plan) {
  const Parting parting(plan);
  const std::vector<uint64_t> bytes = bytes_read(plan);
  std::map<int, std::vector<int>> stages;  // by unit
  std::map<int, std::set<int>> needs;
  for (size_t i = 0; i < plan.stages.size(); i++)
    for (const int unit : parting.makers(int(i))) {
      stages[unit].push_back(int(i));
      for (const int source : plan.stages[i].sources)
        if (const std::set<int>& theirs = parting.makers(source); !theirs.contains(unit))
          needs[unit].insert(theirs.begin(), theirs.end());
    }

  const auto name_of_stage = [&](int i) { return plan.stages[size_t(i)].node->name; };
  std::vector<Unit> units;
  for (const auto& [last, members] : stages) {
    Unit unit;
    unit.name = name_of_stage(last);
    Hasher kind;
    for (const int i : members) {
      const Stage& s = plan.stages[size_t(i)];
      unit.nodes.push_back(s.node->name);
      unit.seconds += seconds_of(plan, s);
      add_costly(kind, *s.node);
    }
    unit.targets.push_back(unit.name);
    unit.is_wanted = plan.stages[size_t(last)].target;
    for (const int n : needs[last]) unit.needs.push_back(name_of_stage(n));
    // Inputs that are up to twice as large count as equal.
    unit.kind = kind.add(int64_t(std::bit_width(bytes[size_t(last)]))).digest();
    units.push_back(std::move(unit));
  }
  return units;
}

std::set<std::string> made_nodes(const Plan& plan) {
  std::set<std::string> made;
  for (const Stage& s : plan.stages)
    if (s.state == StageState::up_to_date || (s.state == StageState::cached && s.known->stored))
      made.insert(s.node->name);
  return made;
}

bool is_done(const Unit& unit, const std::set<std::string>& made) {
  return std::ranges::all_of(unit.targets, [&](const std::string& name) { return made.contains(name); });
}

std::vector<bool> due(const std::vector<Unit>& units, const Plan& plan) {
  std::map<std::string, size_t> index;
  for (size_t i = 0; i < units.size(); i++) index.emplace(units[i].name, i);
  const std::set<std::string> made = made_nodes(plan);
  std::vector<bool> wanted(units.size()), out(units.size());
  for (size_t i = units.size(); i-- > 0;) {
    if (!(wanted[i] || units[i].is_wanted) || is_done(units[i], made)) continue;
    out[i] = true;
    for (const std::string& n : units[i].needs) wanted[index.at(n)] = true;
  }
  return out;
}

}  // namespace terrazzo
