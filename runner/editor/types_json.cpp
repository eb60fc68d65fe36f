#include "runner/editor/types_json.h"

#include <fmt/format.h>

#include "graphs/document/load.h"
#include "graphs/edit/edit_context.h"
#include "graphs/text/stock_graphs.h"
#include "graphs/tools/descriptor_json.h"

namespace terrazzo {

using nlohmann::ordered_json;

namespace {

std::string type_text(const JsonValue* node) {
  const JsonValue* type = node ? node->find("type") : nullptr;
  return type && type->is_text() ? type->text : "";
}

void count_uses(const JsonValue& graph, ordered_json& out) {
  const JsonValue* nodes = graph.find("nodes");
  if (!nodes) return;
  for (const JsonMember& m : nodes->members) {
    ordered_json& use = out[type_text(&m.value)];
    if (use.is_null()) use = {{"count", 0}, {"behind", ordered_json::object()}};
    use["count"] = use["count"].get<int>() + 1;
    for (const std::string& name : edits::named_nodes(m.value))
      if (const std::string source = type_text(nodes->find(name)); !source.empty())
        use["behind"][source] = use["behind"].value(source, 0) + 1;
  }
}

/// By type: how often the stock graphs use it, and how often behind which other.
ordered_json uses_in_stock_graphs() {
  ordered_json out = ordered_json::object();
  for (const StockGraph& stock : stock_graphs()) {
    const ParsedJson parsed = parse_json(stock.text);
    if (!parsed.value) continue;
    count_uses(*parsed.value, out);
    if (const JsonValue* graphs = parsed.value->find("graphs"))
      for (const JsonMember& m : graphs->members) count_uses(m.value, out);
  }
  return out;
}

}  // namespace

ordered_json parameter_as_json(const GraphParameter& p) {
  ordered_json out = json_of_param(p.param);
  if (p.formula) out["default"] = p.formula->text.text;
  if (!p.group.empty()) out["group"] = p.group;
  if (p.visible_if) out["visible_if"] = p.visible_if->text;
  return out;
}

const ordered_json& types_json() {
  static const ordered_json all = [] {
    ordered_json types = ordered_json::array(), graphs = ordered_json::array();
    for (const NodeType& t : node_types()) types.push_back(json_of_type(t));
    for (const StockGraph& stock : stock_graphs()) {
      const GraphInterface graph = read_interface_text(stock.text, std::string(stock.name) + ".json");
      ordered_json inputs = ordered_json::array(), outputs = ordered_json::array(), parameters = ordered_json::array();
      for (const Port& p : graph.inputs) inputs.push_back(json_of_port(p));
      for (const Port& p : graph.outputs) outputs.push_back(json_of_port(p));
      for (const GraphParameter& p : graph.parameters) parameters.push_back(parameter_as_json(p));
      graphs.push_back({{"name", "stock:" + std::string(stock.name)},
                        {"category", graph_category},
                        {"summary", graph.summary},
                        {"help", graph.help},
                        {"inputs", std::move(inputs)},
                        {"outputs", std::move(outputs)},
                        {"parameters", std::move(parameters)}});
    }
    ordered_json categories = categories_of(node_types());
    categories.push_back(graph_category);
    return ordered_json{{"types", std::move(types)},
                        {"graphs", std::move(graphs)},
                        {"categories", std::move(categories)},
                        {"uses", uses_in_stock_graphs()}};
  }();
  return all;
}

}  // namespace terrazzo
