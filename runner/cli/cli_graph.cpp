#include "runner/cli/cli_graph.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/file/file_io.h"
#include "core/file/private_folder.h"
#include "graphs/text/read_document.h"
#include "graphs/text/stock_graphs.h"
#include "graphs/tools/pack.h"
#include "graphs/tools/reference.h"
#include "runner/cache/cache.h"

namespace terrazzo {

namespace fs = std::filesystem;

void GraphFlags::open_pack(const std::optional<fs::path>& cache) {
  if (!is_pack(graph)) {
    pack.clear();
    return;
  }
  if (cache) {
    pack = unpacked(graph, fs::absolute(*cache) / "packs");
    return;
  }
  if (!passing) passing = std::make_shared<PrivateFolder>(fs::temp_directory_path(), "pack");
  pack = unpacked(graph, passing->path());
}

void GraphFlags::open_pack() {
  std::optional<fs::path> cache;
  try {
    cache = Cache::default_folder();
    return open_pack(cache);
  } catch (const FileError&) {
    if (!cache) throw;
  } catch (const Error&) {
    if (cache) throw;
  }
  open_pack(std::nullopt);
}

std::vector<fs::path> GraphFlags::unpack_for_run(bool keeps, const std::string& cache) {
  if (!keeps)
    open_pack(std::nullopt);
  else if (cache.empty())
    open_pack();
  else
    open_pack(fs::path(cache));
  return pack.empty() ? std::vector<fs::path>() : std::vector{pack};
}

std::vector<Override> GraphFlags::overrides() const {
  std::vector<Override> out = overrides_from(set);
  for (Override& o : out) o.allows_reading = true;
  return out;
}

LoadedGraph GraphFlags::load(LoadOptions options, const std::vector<Override>& more) const {
  std::vector<Override> all = overrides();
  all.insert(all.end(), more.begin(), more.end());
  options.presets = presets;
  options.settings.assign(settings.begin(), settings.end());
  if (pack.empty()) return load_graph(graph, all, options);
  options.pack = pack;
  return load_graph_text(read_document(pack / "graph.json"), graph, all, options);
}

std::vector<ProtectedFile> GraphFlags::files() const {
  std::vector<ProtectedFile> out = {{graph, "it is the graph file"}};
  out.push_back({std::filesystem::path(graph).replace_extension(".presets.json"), "it holds the graph's presets"});
  for (const std::string& file : settings) out.push_back({file, "--params reads it"});
  return out;
}

std::vector<std::string> shown_warnings(const std::string& graph, const std::vector<Problem>& warnings) {
  std::vector<std::string> out;
  for (size_t i = 0; i < std::min(warnings.size(), most_problems_shown); i++)
    out.push_back(describe(graph, warnings[i]));
  if (const std::string more = problems_not_shown(warnings.size(), "warning"); !more.empty()) out.push_back(more);
  return out;
}

void add_graph_argument(Command& command, GraphFlags& flags) {
  command.add_option("GRAPH", &flags.graph, "The graph file; stock:NAME for one that comes with the program")
      .required()
      .takes("FILE.json")
      .suggests(stock_names(stock_prefix));
}

std::vector<std::string> stock_names(std::string_view prefix) {
  std::vector<std::string> out;
  for (const StockGraph& g : stock_graphs()) out.push_back(fmt::format("{}{}", prefix, g.name));
  return out;
}

void add_value_flags(Command& command, GraphFlags& flags) {
  const auto add = [&](const char* name, std::vector<std::string>& values, const char* type, const char* help) {
    command.add_option(name, &values, help).takes(type).repeated();
  };
  add("--set", flags.set, "NAME=VALUE",
      "Sets a graph parameter, or node.parameter; may be given several times. GRAPH --help lists the parameters");
  add("--preset", flags.presets, "NAME", "Sets the values of a preset of the graph; later presets take precedence");
  add("--params", flags.settings, "FILE.json",
      "Sets the values in a JSON file, an object. Takes precedence over presets, --set over it");
}

namespace {

/// The interface of the given graph; nullopt if the command takes no graph or none is given.
std::optional<GraphInterface> named_interface(const Command& command) {
  const CommandOption* graph = command.find_option("GRAPH");
  if (!graph || graph->given.empty()) return std::nullopt;
  const std::string& file = graph->given.front();
  std::error_code missing;
  if (std::filesystem::is_directory(file, missing)) return std::nullopt;  // for `edit`: a folder of maps
  return is_pack(file) ? read_interface_text(graph_in_pack(file), file) : read_interface(file);
}

}  // namespace

std::string set_hint(const Command& command, const std::string& option) {
  const std::string name = option.substr(std::min(option.size(), size_t{2}), option.find('=') - 2);
  try {
    if (!command.find_option("--set")) return "";
    const std::optional<GraphInterface> graph = named_interface(command);
    if (!graph) return "";
    for (const GraphParameter& p : graph->parameters)
      if (p.param.name == name) return fmt::format("; --set {0}=VALUE sets the graph's parameter {0}", name);
  } catch (const Error&) {
    // Errors of the graph are reported elsewhere.
  }
  return "";
}

std::string help_on_graph(const Command& command) {
  const std::optional<GraphInterface> graph = named_interface(command);
  return graph ? graph_reference(command.find_option("GRAPH")->given.front(), *graph) : "";
}

}  // namespace terrazzo
