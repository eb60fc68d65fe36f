#include "runner/engine/plan.h"

#include <algorithm>
#include <array>
#include <unordered_map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/suggest.h"
#include "core/base/text.h"
#include "runner/engine/history.h"
#include "runner/engine/preflight.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

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
  for (Stage& s : stages) s.target |= s.node->fails;  // it is to be told of, whoever needed it
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

/// Why a sink's files are not what it wrote; empty if they are.
std::string trouble_with_files(const StageRecord& record, Cache* cache) {
  for (const OutputFile& f : record.files) {
    std::error_code missing;
    const uint64_t bytes = fs::file_size(f.path, missing);
    if (missing) return fmt::format("output file {} is missing", f.path.string());
    if (bytes != f.bytes || cache->file_digest(f.path) != f.content)
      return fmt::format("output file {} was changed since", f.path.string());
  }
  return "";
}

std::string why_new(const Stage& stage, const Resolution& r, const Cache* cache, const History* history) {
  if (!cache) return "no cache is used";
  const std::string difference = history ? history->first_difference(stage.node->name, r.ingredients) : "";
  return difference.empty() ? "never run before with these inputs and parameters" : difference;
}

std::string why_must_run(const Stage& stage, const Resolution& r, Cache* cache, const History* history) {
  const NodeType& type = stage.type();
  if (r.record) {
    if (type.is_sink()) return trouble_with_files(*r.record, cache);
    return stage.target && type.persist == Persist::payload && !r.stored ? "its stored result is gone" : "";
  }
  // A lazy stage has its names without running; it runs for a reader, or because it has been asked for.
  return r.names.empty() || stage.target ? why_new(stage, r, cache, history) : "";
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

/// From the last stage to the first: what each one does, given what its readers want of it.
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

}  // namespace

std::string_view name_of(StageState state) {
  constexpr std::array<std::string_view, 6> names = {"not needed", "cached", "up to date", "derived", "depends", "run"};
  return names[static_cast<size_t>(state)];
}

bool is_complete(const StageRecord& record, const NodeType& type) {
  return std::all_of(type.outputs.begin(), type.outputs.end(),
                     [&](const Port& p) { return record.outputs.count(p.name) == 1; });
}

Digest digest_of_file(Cache* cache, const fs::path& path) {
  return cache ? cache->file_digest(path) : file_content_digest(path);
}

std::map<std::string, Digest> names_of(const NodeType& type, const Digest& key,
                                       const std::map<std::string, Value>& values) {
  std::map<std::string, Digest> names;
  for (const Port& p : type.outputs)
    names[p.name] = type.persist == Persist::derived ? derived_name(key, p.name) : digest_of(values.at(p.name));
  return names;
}

namespace {

/// What only the runs before can tell: what is new about lazy stages, and which stages have never run.
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

}  // namespace

Resolution resolve(const Plan& plan, int index, Cache* cache, const History* history) {
  const Stage& stage = plan.stages[index];
  InputNames inputs;
  Places sources;
  for (const int source : stage.sources) sources[plan.stages[source].node->name] = source;
  for (const auto& [port, wires] : stage.node->inputs)
    for (const Wire& w : wires) inputs[port].push_back(plan.stages[sources.at(w.node)].known->names.at(w.port));

  Resolution r;
  r.ingredients =
      ingredients_of(*stage.node, inputs, [&](const fs::path& file) { return digest_of_file(cache, file); });
  r.key = key_of(r.ingredients);
  if (cache) r.record = cache->find_stage(r.key);
  if (r.record && !is_complete(*r.record, stage.type())) r.record.reset();
  if (r.record) r.names = r.record->outputs;
  if (!r.record && stage.type().persist == Persist::derived) r.names = names_of(stage.type(), r.key, {});
  if (r.record && stage.type().persist == Persist::payload)
    r.stored = std::all_of(stage.used_outputs.begin(), stage.used_outputs.end(),
                           [&](const std::string& port) { return cache->has_value(r.names.at(port)); });
  r.must_run = why_must_run(stage, r, cache, history);
  return r;
}

namespace {

/// Problems of nodes end the plan, or with `keep_going` are left to the run, which goes on without these nodes. The one
/// place where that is decided.
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

int Plan::count(StageState state) const {
  return static_cast<int>(
      std::count_if(stages.begin(), stages.end(), [&](const Stage& s) { return s.state == state; }));
}

std::string Plan::summary() const {
  std::vector<std::string> parts;
  const auto add = [&](StageState state, std::string_view what) {
    if (count(state) > 0) parts.push_back(fmt::format("{} {}", count(state), what));
  };
  add(StageState::cached, "cached");
  add(StageState::up_to_date, "up to date");
  add(StageState::derived, "derived");
  add(StageState::run, "to run");
  add(StageState::depends, "undecided until earlier stages have run");
  return fmt::format("{}: {}", counted(needed(), "stage"), fmt::join(parts, ", "));
}

std::string Plan::table() const {
  std::vector<std::array<std::string, 6>> rows = {{"node", "type", "shape", "state", "key", "why"}};
  for (const Stage& s : stages)
    rows.push_back({s.node->name, s.type().name, describe(s.shape), std::string(name_of(s.state)),
                    s.known ? s.known->key.hex().substr(0, 8) : "-", s.reason});
  std::array<size_t, 6> widths{};
  for (const auto& row : rows)
    for (size_t i = 0; i < row.size(); i++) widths[i] = std::max(widths[i], row[i].size());
  std::string out = summary() + "\n";
  for (const auto& row : rows) {
    std::string line;
    for (size_t i = 0; i < row.size(); i++) line += fmt::format("  {:<{}}", row[i], widths[i]);
    out += line.erase(line.find_last_not_of(' ') + 1) + "\n";
  }
  return out;
}

}  // namespace terrazzo
