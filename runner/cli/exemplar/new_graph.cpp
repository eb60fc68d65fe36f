#include "runner/cli/exemplar/new_graph.h"

#include "core/exemplar/features.h"
#include "graphs/text/stock_graphs.h"
#include "nodes/common/exemplar_lint.h"
#include "runner/api/session.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/cli_run.h"
#include "runner/cli/exemplar/starting_graph.h"
#include "runner/terminal/console.h"
#include "runner/terminal/usage.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// The folder's path for a graph file in `beside`.
fs::path seen_from(const fs::path& beside, const fs::path& folder) {
  const fs::path relative =
      fs::absolute(folder).lexically_normal().lexically_relative(fs::absolute(beside).lexically_normal());
  return relative.empty() ? fs::absolute(folder) : relative;
}

RunResult run_on_folder(const Graph& graph, const RunRequest& request, const std::string& folder) {
  try {
    return Session({.use_cache = false}).run(graph, request);
  } catch (const GraphError& e) {
    std::vector<Problem> problems;
    for (const Problem& p : e.problems()) problems.push_back({{}, "FOLDER", for_command_line(p.message, folder)});
    throw GraphError("", std::move(problems));
  }
}

}  // namespace

std::string_view stock_graph_like(const ExemplarFlags& exemplar) {
  return exemplar.is_picture() ? "texture" : "material";
}

NewGraph new_graph(const ExemplarFlags& exemplar, const fs::path& out, const std::string& like,
                   const std::atomic<bool>& cancelled) {
  const Graph graph = inspection_graph(exemplar);
  const RunResult result =
      run_on_folder(graph, {.keep = {"exemplar", "elements"}, .cancelled = &cancelled}, exemplar.folder);
  for (const Failure& f : result.failures) print_message("error: {}\n", f.message);
  print_warnings(result);
  if (!result.ok()) return {.exit_code = result.cancelled ? exit_cancelled : exit_failed};
  const auto features = std::get<FeaturesPtr>(result.kept.at("elements").at("features"));
  ExemplarFindings look{.exemplar = std::get<MaterialPtr>(result.kept.at("exemplar").at("material")),
                        .folder = seen_from(fs::absolute(out).parent_path(), exemplar.folder),
                        .name = exemplar.name,
                        .interpret = exemplar.interpretations(),
                        .notes = result.stages[0].notes,
                        .lattice_notes = result.stages[2].notes,
                        .repeats = features->repeats().lattice.rank > 0,
                        .streaks = features->repeats().streaks.any(),
                        .tiles = features->wraps(),
                        .method = suitable_method(*features, Task())};
  if (const ImagePtr color = look.exemplar->find(std::string(name_of(Semantic::base_color))))
    look.faults = exemplar_faults(*color);
  NewGraph made{.text = starting_graph(look, stock_graph(like)),
                .findings = {"found " + look.exemplar->map_names(), look.nature(), look.advice()}};
  if (const std::string light = look.light(); !light.empty())
    made.findings.push_back(light + "; the node \"delight\" takes it out");
  if (const LoneFeature& lone = look.faults.lone; lone.is_seen())
    made.findings.push_back(lone_feature_message("base_color", lone));
  return made;
}

}  // namespace terrazzo
