#include "runner/plan/planning.h"

#include <algorithm>
#include <iterator>
#include <unordered_map>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "graphs/text/problem.h"
#include "runner/plan/history.h"
#include "runner/plan/preflight.h"

namespace terrazzo {

namespace {

void add_once(std::vector<int>& list, int value) {
  if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

void add_once(std::vector<std::string>& list, const std::string& value) {
  if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

using Places = std::unordered_map<std::string_view, int>;

int find_stage(const Graph& graph, const Places& places, const std::string& name) {
  const auto at = places.find(name);
  if (at != places.end()) return at->second;
  std::vector<std::string> names;
  for (const GraphNode& n : graph.nodes) names.push_back(n.name);
  throw Error(fmt::format("there is no node \"{}\"{}", name, suggestion(name, names)));
}

std::vector<Stage> make_stages(const Graph& graph, const Places& places) {
  std::vector<Stage> stages(graph.nodes.size());
  for (size_t i = 0; i < stages.size(); i++) {
    stages[i].node = &graph.nodes[i];
    for (const auto& [port, wires] : graph.nodes[i].inputs)
      for (const Wire& w : wires) add_once(stages[i].sources, places.at(w.node));
  }
  return stages;
}

void choose_targets(Plan& plan, const Places& places, const PlanOptions& options) {
  std::vector<Stage>& stages = plan.stages;
  for (const std::string& name : options.only) stages[find_stage(*plan.graph, places, name)].target = true;
  for (const std::string& name : options.keep) {
    Stage& s = stages[find_stage(*plan.graph, places, name)];
    s.target = s.kept = true;
  }
  for (Stage& s : stages) s.target |= s.node->fails;  // reported even if no one needs it
  if (!options.only.empty()) return;
  bool any_sink = false;
  for (Stage& s : stages)
    if (s.type().is_sink()) any_sink = s.target = true;
  if (any_sink) return;
  std::vector<bool> read(stages.size(), false);
  for (const Stage& s : stages)
    for (const int source : s.sources) read[source] = true;
  for (size_t i = 0; i < stages.size(); i++)
    if (!read[i]) stages[i].target = true;
}

void mark_needed(Plan& plan) {
  for (size_t i = plan.stages.size(); i-- > 0;) {
    Stage& s = plan.stages[i];
    s.needed = s.needed || s.target;
    if (!s.needed) continue;
    for (const int source : s.sources) plan.stages[source].needed = true;
  }
}

void link_readers(Plan& plan, const Places& places) {
  for (size_t i = 0; i < plan.stages.size(); i++) {
    Stage& s = plan.stages[i];
    if (s.target)
      for (const Port& p : s.type().outputs) s.used_outputs.push_back(p.name);
    if (!s.needed) continue;
    for (const int source : s.sources) plan.stages[source].readers.push_back(static_cast<int>(i));
    for (const auto& [port, wires] : s.node->inputs)
      for (const Wire& w : wires) add_once(plan.stages[places.at(w.node)].used_outputs, w.port);
  }
}

enum class Want : uint8_t { none, maybe, surely };

std::string name_of_reader(const Plan& plan, const Stage& s, const std::vector<bool>& asks) {
  for (const int r : s.readers)
    if (asks[r]) return "@" + plan.stages[r].node->name;
  return "the caller";
}

void decide_settled(Stage& s, Want want, const std::string& reader) {
  const bool lazy = s.type().persist == Persist::derived;
  const bool idle = want == Want::none || s.loadable();
  s.state = lazy ? StageState::derived : s.type().is_sink() ? StageState::up_to_date : StageState::cached;
  if (idle) return;
  if (lazy) {
    s.reason = fmt::format("made when {} asks for it", reader);
  } else if (want == Want::surely) {
    s.state = StageState::run;
    s.reason = fmt::format("{} needs its result, which is not stored", reader);
  } else {
    s.reason = fmt::format("made again if {} runs: its result is not stored", reader);
  }
}

/// Decides from the last stage to the first what each does, given the needs of its readers.
void decide_states(Plan& plan) {
  const size_t n = plan.stages.size();
  std::vector<bool> surely(n, false), maybe(n, false);  // whether a stage asks its sources for values
  for (size_t i = n; i-- > 0;) {
    Stage& s = plan.stages[i];
    if (!s.needed) continue;
    const auto wanted_by = [&](const std::vector<bool>& asks) {
      return std::any_of(s.readers.begin(), s.readers.end(), [&](int r) { return asks[r]; });
    };
    if (!s.faults.empty()) {
      s.state = StageState::run;
      s.reason = "cannot run: " + s.faults.front();
      continue;
    }
    const Want want = s.kept || wanted_by(surely) ? Want::surely : wanted_by(maybe) ? Want::maybe : Want::none;
    if (!s.known) {
      s.state = StageState::depends;
      const auto open = std::find_if(s.sources.begin(), s.sources.end(), [&](int source) {
        return !plan.stages[source].known || plan.stages[source].known->names.empty();
      });
      s.reason = fmt::format("depends on what @{} gives", plan.stages[*open].node->name);
      maybe[i] = true;
    } else if (!s.known->must_run.empty()) {
      s.state = StageState::run;
      s.reason = s.known->must_run;
      surely[i] = true;
    } else {
      decide_settled(s, want, name_of_reader(plan, s, want == Want::surely ? surely : maybe));
      const bool reads = want != Want::none && !s.loadable();
      surely[i] = reads && want == Want::surely;
      maybe[i] = reads && want == Want::maybe;
    }
  }
}

/// Facts from the history: changes of lazy stages, and stages that have never run.
void add_what_is_known(Plan& plan, const History& history) {
  for (Stage& s : plan.stages) {
    const std::string& node = s.node->name;
    if (s.state == StageState::depends && !history.seconds(node)) {
      s.reason = "never run before; " + s.reason;
    } else if (s.state == StageState::derived && !s.known->record) {
      const std::string difference = history.first_difference(node, s.known->ingredients);
      if (!difference.empty()) s.reason = fmt::format("{}{}{}", difference, s.reason.empty() ? "" : "; ", s.reason);
    }
  }
}

double expected_seconds(const Stage& stage, const History* history) {
  constexpr double unknown = 1;
  const bool computes = stage.needed && (stage.state == StageState::run || stage.state == StageState::depends);
  if (!computes || stage.type().persist == Persist::derived) return 0;
  if (stage.known && stage.known->record) return stage.known->record->seconds;
  const std::optional<double> before = history ? history->seconds(stage.node->name) : std::nullopt;
  return before.value_or(unknown);
}

/// Problems of nodes end the planning or, with `keep_going`, become faults, so that the run continues without these
/// nodes. This is the only place where that is decided.
void take_problems(Plan& plan, const Places& places, std::vector<Problem> of_nodes, std::vector<Problem> of_run,
                   const PlanOptions& options) {
  const std::string file = plan.graph->file.string();
  if (options.keep_going)
    for (const Problem& p : of_nodes) plan.stages[places.at(p.node)].faults.push_back(describe(file, p));
  else
    std::ranges::move(of_nodes, std::back_inserter(of_run));
  if (!of_run.empty()) throw GraphError(file, std::move(of_run));
}

}  // namespace

Plan make_plan(const Graph& graph, Cache* cache, const PlanOptions& options, const History* history) {
  Places places;
  for (size_t i = 0; i < graph.nodes.size(); i++) places[graph.nodes[i].name] = static_cast<int>(i);
  Plan plan{&graph, make_stages(graph, places)};
  choose_targets(plan, places, options);
  mark_needed(plan);
  link_readers(plan, places);
  take_problems(plan, places, oversize_problems(plan), {}, options);
  for (size_t i = 0; i < plan.stages.size(); i++) {
    Stage& s = plan.stages[i];
    const bool ready = s.needed && s.faults.empty() && std::all_of(s.sources.begin(), s.sources.end(), [&](int source) {
                         const std::optional<Resolution>& known = plan.stages[source].known;
                         return known && !known->names.empty();
                       });
    if (ready) s.known = resolve(plan, static_cast<int>(i), cache, history);
  }
  decide_states(plan);
  if (history) add_what_is_known(plan, *history);
  for (Stage& s : plan.stages) s.expected_seconds = expected_seconds(s, history);
  if (!options.look_ahead) return plan;
  PreflightProblems problems = preflight_problems(plan);
  take_problems(plan, places, std::move(problems.of_nodes), std::move(problems.of_run), options);
  if (std::ranges::any_of(plan.stages, [](const Stage& s) { return !s.faults.empty(); })) decide_states(plan);
  return plan;
}

}  // namespace terrazzo
