#include "runner/cli/cli_graph.h"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "graphs/document/pack.h"
#include "graphs/document/read_document.h"
#include "graphs/document/reference.h"
#include "runner/cache/cache.h"

namespace terrazzo {

namespace {

/// Where packs are unpacked.
std::filesystem::path pack_folder() {
  return Cache::default_folder() / "packs";
}

}  // namespace

LoadedGraph GraphFlags::load(LoadOptions options) const {
  options.presets = presets;
  options.settings.assign(settings.begin(), settings.end());
  if (!is_pack(graph)) return load_graph(graph, set, options);
  const std::filesystem::path place = unpacked(graph, pack_folder());
  options.settings.insert(options.settings.begin(), place / "settings.json");
  return load_graph_text(read_document(place / "graph.json"), graph, set, options);
}

std::vector<KeptFile> GraphFlags::files() const {
  std::vector<KeptFile> out = {{graph, "it is the graph file"}};
  out.push_back({std::filesystem::path(graph).replace_extension(".presets.json"), "it holds the graph's presets"});
  for (const std::string& file : settings) out.push_back({file, "--params reads it"});
  return out;
}

void add_graph_argument(CLI::App& command, GraphFlags& flags) {
  command.add_option("GRAPH", flags.graph, "The graph file")->required()->type_name("FILE.json");
}

void add_value_flags(CLI::App& command, GraphFlags& flags) {
  const auto add = [&](const char* name, std::vector<std::string>& values, const char* type, const char* help) {
    command.add_option(name, values, help)->type_name(type)->take_all()->expected(1);
  };
  add("--set", flags.set, "NAME=VALUE",
      "Sets a graph parameter, or node.parameter; may be given several times. GRAPH --help lists the parameters");
  add("--preset", flags.presets, "NAME", "Sets what a preset of the graph says; of several, the last counts most");
  add("--params", flags.settings, "FILE.json",
      "Sets what a file says, an object of values by name. Counts more than presets, less than --set");
}

namespace {

/// The graph file that has been named; empty if the command takes none or none has been named.
std::filesystem::path named_graph(const CLI::App& command) {
  const CLI::Option* graph = command.get_option_no_throw("GRAPH");
  if (!graph || graph->results().empty()) return {};
  const std::string& file = graph->results().front();
  return is_pack(file) ? unpacked(file, pack_folder()) / "graph.json" : std::filesystem::path(file);
}

}  // namespace

std::string set_hint(const CLI::App& command, const std::string& option) {
  const std::string name = option.substr(std::min(option.size(), size_t{2}), option.find('=') - 2);
  try {
    const std::filesystem::path graph = named_graph(command);
    if (graph.empty() || !command.get_option_no_throw("--set")) return "";
    for (const GraphParameter& p : read_interface(graph).parameters)
      if (p.param.name == name) return fmt::format("; --set {0}=VALUE sets the graph's parameter {0}", name);
  } catch (const Error&) {
    // A graph that cannot be read has been complained about, or will be.
  }
  return "";
}

std::string help_on_graph(const CLI::App& command) {
  const std::filesystem::path graph = named_graph(command);
  return graph.empty() ? "" : graph_reference(command.get_option("GRAPH")->results().front(), read_interface(graph));
}

}  // namespace terrazzo
