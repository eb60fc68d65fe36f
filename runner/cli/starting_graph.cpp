#include "runner/cli/starting_graph.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "core/analysis/space/weighting.h"
#include "core/base/text.h"
#include "graphs/document/convert.h"
#include "graphs/document/format.h"
#include "graphs/document/json.h"
#include "graphs/document/stock_graphs.h"

namespace terrazzo {

namespace {

JsonValue& member(JsonValue& object, std::string_view name) {
  if (JsonValue* found = object.find(name)) return *found;
  throw std::logic_error(fmt::format("the stock graph has no \"{}\"", name));
}

void put(JsonValue& object, const std::string& name, JsonValue value) {
  if (JsonValue* there = object.find(name))
    *there = std::move(value);
  else
    object.members.push_back({name, {}, std::move(value)});
}

JsonValue weights_of(const Material& exemplar) {
  JsonValue weights;
  weights.kind = JsonValue::Kind::object;
  for (const Map& m : exemplar.maps())
    weights.members.push_back({m.name, {}, json_of(default_weight(m.image->info().semantic))});
  return weights;
}

void comment(JsonValue& value, const std::string& text) {
  value.comments_before.push_back("// " + text);
}

}  // namespace

std::string starting_graph(const Material& exemplar, const std::filesystem::path& folder,
                           const std::vector<std::string>& notes) {
  ParsedJson parsed = parse_json(stock_graph("material"));
  if (!parsed.value) throw std::logic_error("the stock graph is no JSON");
  JsonValue& graph = *parsed.value;
  // A default is taken as it is: "$" and "@" mean nothing in it.
  put(member(member(graph, "parameters"), "material"), "default", JsonValue::of(folder.generic_string()));

  JsonValue& nodes = member(graph, "nodes");
  JsonValue& exemplar_node = member(nodes, "exemplar");
  comment(exemplar_node, "What was found in " + folder.generic_string() + ":");
  for (const Map& m : exemplar.maps())
    comment(exemplar_node, fmt::format("  {}: {}x{}, {}", m.name, m.image->width(), m.image->height(),
                                       counted(m.image->channels(), "channel")));
  for (const std::string& note : notes) comment(exemplar_node, "  " + note);

  JsonValue& weighted = member(nodes, "weighted");
  comment(weighted, "How much each map counts when neighbourhoods are compared; 0 leaves a map out.");
  put(weighted, "weights", weights_of(exemplar));
  comment(member(nodes, "guides"),
          "Edges keep features such as joints and cracks whole. `terrazzo nodes guidance` says more.");
  comment(member(nodes, "layout"), "Another seed gives another variation; nothing before this node runs again for it.");
  return formatted(graph);
}

}  // namespace terrazzo
