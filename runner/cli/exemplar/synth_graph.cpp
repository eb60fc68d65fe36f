#include "runner/cli/exemplar/synth_graph.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "graphs/text/format.h"
#include "graphs/text/json.h"
#include "graphs/text/stock_graphs.h"
#include "nodes/common/registry.h"
#include "nodes/exchange/export_preset.h"

namespace terrazzo {

namespace {

JsonValue object_of(const std::vector<std::pair<std::string, std::string>>& members) {
  JsonValue out = JsonValue::empty_object();
  for (const auto& [name, text] : members) out.set(name, JsonValue::of(text));
  return out;
}

/// The file formats that the node takes; some presets refuse some of them.
JsonValue preset_formats() {
  JsonValue list;
  list.kind = JsonValue::Kind::list;
  const std::vector<Param>& params = find_node_type("export_preset")->params;
  for (const std::string& format : std::ranges::find(params, "format", &Param::name)->choices)
    list.items.push_back(JsonValue::of(format));
  return list;
}

}  // namespace

std::vector<std::string> engine_names() {
  std::vector<std::string> out;
  for (const ExportPreset& p : export_presets())
    if (p.name != "maps") out.emplace_back(p.name);
  return out;
}

std::string synth_graph(std::string_view stock, const ExemplarFlags& exemplar, const std::string& engine) {
  ParsedJson parsed = parse_json(stock_graph(stock));
  if (!parsed.value) throw std::logic_error("the stock graph is not JSON");
  JsonValue& graph = *parsed.value;
  JsonValue& nodes = *graph.find("nodes");
  if (exemplar.is_picture()) {
    std::erase_if(graph.find("parameters")->members, [](const JsonMember& m) { return m.name == "name"; });
    nodes.set("exemplar", object_of({{"type", "load_map"}, {"path", "$material"}}));
  }
  if (!engine.empty()) {
    JsonValue files = object_of({{"type", "export_preset"},
                                 {"material", "@result"},
                                 {"preset", engine},
                                 {"format", "$format"},
                                 {"path", "$out"}});
    // A picture knows only what it is.
    if (exemplar.is_picture()) files.set("name", JsonValue::of(std::filesystem::path(exemplar.folder).stem().string()));
    nodes.set("files", std::move(files));
    graph.find("parameters")->find("format")->set("choices", preset_formats());
  }
  return formatted(graph);
}

}  // namespace terrazzo
