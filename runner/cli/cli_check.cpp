#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/text.h"
#include "runner/api/session.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/cli_graph.h"
#include "runner/plan/preflight.h"
#include "runner/plan/source_findings.h"
#include "runner/report/problem_json.h"
#include "runner/terminal/console.h"
#include "runner/terminal/limit_flags.h"
#include "runner/terminal/signals.h"

namespace terrazzo {

namespace {

using Json = nlohmann::ordered_json;

struct CheckFlags : GraphFlags {
  bool json = false;
  LimitFlags limits;
};

/// The findings of a check.
struct Findings {
  std::vector<Problem> errors, warnings, notes;
  size_t nodes = 0, parameters = 0;
};

/// Runs preflight on the nodes that do not depend on an unset parameter or input.
void check_what_is_set(const Graph& graph) {
  std::vector<GraphNode> complete;
  for (const GraphNode& n : graph.nodes)
    if (n.params.size() == n.type->params.size() && !n.is_open) complete.push_back(n);
  if (std::vector<Problem> problems = preflight_of_nodes(complete); !problems.empty())
    throw GraphError(graph.file.string(), std::move(problems));
}

/// Throws GraphError.
Findings look_at(const CheckFlags& flags) {
  Findings out;
  GraphFlags opened = flags;
  opened.open_pack();
  LoadedGraph loaded = opened.load({.allow_unset = true, .look_ahead = preflight_of_nodes});
  out.nodes = loaded.graph.nodes.size();
  out.parameters = loaded.parameters.size();
  out.warnings = std::move(loaded.warnings);
  out.notes = std::move(loaded.conversions);
  const auto unset = std::ranges::find_if(loaded.parameters, [](const GraphParameter& p) { return !p.value; });
  const auto note = [&](const std::string& message) { out.notes.push_back({{}, "", message, "", "", "unset"}); };
  if (unset != loaded.parameters.end()) {
    check_what_is_set(loaded.graph);
    note(fmt::format("nodes that depend on an unset parameter were not checked: --set {}=VALUE", unset->param.name));
  } else if (!loaded.inputs.empty()) {
    check_what_is_set(loaded.graph);
    note("nodes that depend on the graph's inputs were checked only as far as possible without them");
  } else {
    Session({.use_cache = false}).plan(loaded.graph);
  }
  const CancelOnSignal signals;
  const Task task(&signals.flag(), {});
  SourceFindings sources = look_at_sources(loaded.graph, task);
  if (!sources.errors.empty()) throw GraphError(loaded.graph.file.string(), std::move(sources.errors));
  std::ranges::move(sources.warnings, std::back_inserter(out.warnings));
  for (Problem& p : lint_of(loaded.graph, task)) out.warnings.push_back(std::move(p));
  return out;
}

void add_to(Json& list, const std::vector<Problem>& problems, const char* severity, ProblemsAsJson& as_json) {
  for (size_t i = 0; i < std::min(problems.size(), most_problems_shown); i++)
    list.push_back(as_json.entry(problems[i], severity));
}

void answer_json(const CheckFlags& flags, const Findings& found) {
  Json problems = Json::array();
  ProblemsAsJson as_json(flags.graph);
  add_to(problems, found.errors, "error", as_json);
  add_to(problems, found.warnings, "warning", as_json);
  add_to(problems, found.notes, "note", as_json);
  size_t not_shown = 0;
  for (const std::vector<Problem>* list : {&found.errors, &found.warnings, &found.notes})
    not_shown += list->size() - std::min(list->size(), most_problems_shown);
  const Json out = {{"graph", flags.graph},           {"valid", found.errors.empty()},   {"nodes", found.nodes},
                    {"parameters", found.parameters}, {"problems", std::move(problems)}, {"not_shown", not_shown}};
  print_result("{}\n", out.dump(2, ' ', false, Json::error_handler_t::replace));
}

int check(const CheckFlags& flags) {
  flags.limits.apply();
  if (flags.json) {
    Findings found;
    try {
      found = look_at(flags);
    } catch (const GraphError& e) {
      found.errors = e.problems();
    }
    answer_json(flags, found);
    return found.errors.empty() ? exit_done : exit_usage;
  }
  const Findings found = look_at(flags);
  size_t notes = 0, warnings = 0;
  for (const Problem& n : found.notes)
    if (n.place.line > 0 && notes++ < most_problems_shown) print_result("note: {}\n", describe(flags.graph, n));
  if (notes > most_problems_shown) print_result("{}\n", problems_not_shown(notes, "note"));
  for (const Problem& w : found.warnings)
    if (warnings++ < most_problems_shown) print_message("warning: {}\n", describe(flags.graph, w));
  if (warnings > most_problems_shown) print_message("{}\n", problems_not_shown(warnings, "warning"));
  for (const Problem& n : found.notes)
    if (n.place.line == 0) print_message("note: {}\n", n.message);
  print_result("{} is valid: {}, {}\n", flags.graph, counted(int64_t(found.nodes), "node"),
               counted(int64_t(found.parameters), "parameter"));
  return exit_done;
}

}  // namespace

void add_check_command(Command& program) {
  Command& command = program.add_command("check", "Checks a graph file without running it");
  command.footer =
      "Reports every mistake at once, with line and column: in the file, in the sources and maps it refers to,\n"
      "and in the paths it would write to. Warns of what is allowed and probably unintended, and of what a run would "
      "warn\n"
      "of when it reads the sources.\n"
      "Examples:\n"
      "  terrazzo check bricks.json\n"
      "  terrazzo check bricks.json --set material=bricks/ --json";
  const auto flags = std::make_shared<CheckFlags>();
  add_graph_argument(command, *flags);
  add_value_flags(command, *flags);
  add_limit_flags(command, flags->limits);
  command.add_flag("--json", &flags->json,
                   "Print the problems, of each severity the first hundred, as JSON: severity, code, file, line, "
                   "column, JSON pointer, node, message");
  command.run = [flags] { return check(*flags); };
}

}  // namespace terrazzo
