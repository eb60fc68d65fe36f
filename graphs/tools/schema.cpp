#include "graphs/tools/schema.h"

#include <nlohmann/json.hpp>

#include "graphs/text/format.h"
#include "graphs/text/migrate.h"
#include "graphs/text/stock_graphs.h"
#include "graphs/values/convert.h"
#include "graphs/values/parameters.h"

namespace terrazzo {

namespace {

using nlohmann::ordered_json;

ordered_json reference(const std::string& definition) {
  return {{"$ref", "#/$defs/" + definition}};
}

ordered_json list_of(ordered_json items) {
  return {{"type", "array"}, {"items", std::move(items)}};
}

ordered_json any_of(std::vector<ordered_json> options) {
  return {{"anyOf", std::move(options)}};
}

ordered_json number(const char* type, const Param& p) {
  ordered_json out = {{"type", type}};
  if (p.min) out["minimum"] = *p.min;
  if (p.max) out["maximum"] = *p.max;
  return out;
}

/// Any text except a wire.
ordered_json text() {
  return {{"type", "string"}, {"pattern", "^($|[^@]|@@)"}};
}

/// Values of texts and numbers inside lists and maps may be references and expressions too.
ordered_json number_or_reference(const char* type, const Param& p) {
  return any_of({number(type, p), reference("reference"), reference("expression")});
}

ordered_json map_of(const Param& p, const ordered_json& values) {
  ordered_json out = {{"type", "object"}, {"additionalProperties", values}};
  if (!p.choices.empty()) out["propertyNames"] = {{"enum", p.choices}};
  return out;
}

ordered_json counted_list(const Param& p, ordered_json items) {
  ordered_json out = list_of(std::move(items));
  if (p.min_count > 0) out["minItems"] = p.min_count;
  if (p.max_count > 0) out["maxItems"] = p.max_count;
  return out;
}

ordered_json value_schema(const Param& p) {
  switch (p.type) {
    case ParamType::boolean:
      return {{"type", "boolean"}};
    case ParamType::integer:
      return number("integer", p);
    case ParamType::number:
      return number("number", p);
    case ParamType::text:
    case ParamType::path:
      return text();
    case ParamType::size: {
      ordered_json pair = list_of(number_or_reference("integer", p));
      pair["minItems"] = pair["maxItems"] = 2;
      return any_of({pair, {{"type", "string"}, {"pattern", "^[0-9]+[xX][0-9]+$"}}, number("integer", p)});
    }
    case ParamType::numbers: {
      if (p.min_count > 1) return counted_list(p, number_or_reference("number", p));
      return any_of({counted_list(p, number_or_reference("number", p)), number("number", p)});
    }
    case ParamType::texts:
      return counted_list(p, text());
    case ParamType::number_map: {
      ordered_json list = list_of(number_or_reference("number", p));
      list["minItems"] = 1;
      return map_of(p, any_of({number_or_reference("number", p), list}));
    }
    case ParamType::text_map:
      return map_of(p, text());
    case ParamType::choice:
      return {{"enum", p.choices}};
  }
  return {};
}

/// A parameter's schema with its default and description; always allows `$name` or an expression instead of the value.
ordered_json param_schema(const Param& p) {
  const bool is_text = p.type == ParamType::text || p.type == ParamType::path;
  ordered_json out =
      is_text ? value_schema(p) : any_of({value_schema(p), reference("reference"), reference("expression")});
  out["description"] = p.help + (p.unit.empty() ? "" : " (" + p.unit + ")");
  if (p.fallback) out["default"] = ordered_json::parse(compact(json_of(*p.fallback)));
  return out;
}

ordered_json port_schema(const Port& p) {
  ordered_json out = any_of({reference("wire"), reference("expression")});
  if (p.list) {
    ordered_json wires = list_of(out);
    if (!p.optional) wires["minItems"] = 1;
    out["anyOf"].push_back(wires);
  }
  out["description"] = std::string(name_of(p.type)) + ": " + p.help;
  return out;
}

/// The keys that every node may have.
ordered_json common_keys_schema() {
  ordered_json one_of = ordered_json::array();
  for (const char* key : {"files", "folders", "table", "values"}) one_of.push_back({{"required", {key}}});
  const ordered_json list_or_text = any_of({{{"type", "array"}, {"minItems", 1}}, {{"type", "string"}}});
  return {{"comment", {{"type", "string"}, {"description", "shown in reports and drawings"}}},
          {"mute", any_of({{{"type", "boolean"}}, reference("reference"), reference("expression")})},
          {"foreach",
           {{"type", "object"},
            {"description", "one node for each of several files, folders, values, or rows of a table"},
            {"properties",
             {{"files", text()},
              {"folders", text()},
              {"table", text()},
              {"values", list_or_text},
              {"as", {{"type", "string"}, {"pattern", "^[A-Za-z][A-Za-z0-9_]*$"}}}}},
            {"additionalProperties", false},
            {"oneOf", one_of}}}};
}

ordered_json node_schema(const NodeType& t) {
  ordered_json properties = {{"type", {{"const", t.name}}}};
  properties.update(common_keys_schema());
  ordered_json required = {"type"};
  for (const Port& p : t.inputs) {
    properties[p.name] = port_schema(p);
    if (!p.optional) required.push_back(p.name);
  }
  for (const Param& p : t.params) {
    properties[p.name] = param_schema(p);
    if (!p.fallback) required.push_back(p.name);
  }
  return {{"type", "object"},
          {"description", t.summary},
          {"properties", properties},
          {"required", required},
          {"additionalProperties", false}};
}

/// A node by its "type": editors follow if-then better than oneOf.
ordered_json any_node_schema(const std::vector<NodeType>& types) {
  ordered_json cases = ordered_json::array();
  for (const NodeType& t : types) {
    cases.push_back({{"if", {{"properties", {{"type", {{"const", t.name}}}}}, {"required", {"type"}}}},
                     {"then", reference("node_" + t.name)}});
  }
  const ordered_json properties = {{"type", {{"type", "string"}, {"minLength", 1}}}};
  return {{"type", "object"}, {"properties", properties}, {"required", {"type"}}, {"allOf", cases}};
}

/// The type of a node in a document without graphs of its own.
ordered_json known_type_schema(const std::vector<NodeType>& types) {
  ordered_json names = ordered_json::array();
  for (const NodeType& t : types) names.push_back(t.name);
  const ordered_json file = {{"type", "string"}, {"pattern", "\\.json$"}, {"description", "a graph in a file"}};
  ordered_json stock = ordered_json::array();
  for (const StockGraph& g : stock_graphs()) stock.push_back("stock:" + std::string(g.name));
  return {{"properties", {{"type", any_of({{{"enum", names}}, {{"enum", stock}}, file})}}}};
}

ordered_json input_schema() {
  const ordered_json flag = {{"type", "boolean"}};
  return {
      {"type", "object"},
      {"properties",
       {{"type", {{"enum", value_type_names}}}, {"help", {{"type", "string"}}}, {"optional", flag}, {"list", flag}}},
      {"required", {"type"}},
      {"additionalProperties", false}};
}

ordered_json output_schema() {
  const ordered_json from = any_of({reference("wire"), reference("expression")});
  const ordered_json described = {
      {"type", "object"},
      {"properties", {{"from", from}, {"type", {{"enum", value_type_names}}}, {"help", {{"type", "string"}}}}},
      {"required", {"from"}},
      {"additionalProperties", false}};
  return any_of({reference("wire"), described});
}

/// The schema of defaults and the further keys of a graph's parameter of this type.
ordered_json parameter_case(const std::string& name, ParamType type) {
  const bool takes_range = type == ParamType::integer || type == ParamType::number || type == ParamType::size ||
                           type == ParamType::numbers || type == ParamType::number_map;
  const bool is_choice = type == ParamType::choice;
  const ordered_json value = is_choice ? text() : value_schema({.name = name, .type = type});
  ordered_json properties = {{"default", any_of({value, reference("expression")})}};
  if (!takes_range) properties["min"] = properties["max"] = false;
  if (!is_choice) properties["choices"] = false;
  ordered_json then = {{"properties", properties}};
  if (is_choice) then["required"] = {"choices"};
  return {{"if", {{"properties", {{"type", {{"const", name}}}}}, {"required", {"type"}}}}, {"then", then}};
}

ordered_json parameter_schema() {
  ordered_json cases = ordered_json::array();
  for (size_t i = 0; i < parameter_type_names().size(); i++)
    cases.push_back(parameter_case(parameter_type_names()[i], static_cast<ParamType>(i)));
  const ordered_json string = {{"type", "string"}};
  ordered_json properties = {{"type", {{"enum", parameter_type_names()}}},
                             {"default", ordered_json::object()},
                             {"help", string},
                             {"min", {{"type", "number"}}},
                             {"max", {{"type", "number"}}},
                             {"unit", string},
                             {"choices", list_of(string)},
                             {"group", string},
                             {"visible_if", reference("expression")}};
  properties["choices"]["minItems"] = 1;
  properties["group"]["description"] = "the heading that it is listed under";
  return {{"type", "object"},
          {"properties", properties},
          {"required", {"type"}},
          {"additionalProperties", false},
          {"allOf", cases}};
}

ordered_json preset_schema() {
  return {
      {"type", "object"},
      {"properties",
       {{"help", {{"type", "string"}}}, {"set", {{"type", "object"}, {"description", "values by NAME or NODE.NAME"}}}}},
      {"additionalProperties", false}};
}

ordered_json definitions(const std::vector<NodeType>& types) {
  ordered_json out;
  out["reference"] = {{"type", "string"},
                      {"description", "the value of a parameter of the graph"},
                      {"pattern", "^\\$([A-Za-z][A-Za-z0-9_]*|\\{[A-Za-z][A-Za-z0-9_]*\\})$"}};
  out["expression"] = {
      {"type", "string"},
      {"description", "an expression, such as \"=size.x / 2\"; a text that begins with = is written =="},
      {"pattern", "^=([^=]|$)"}};
  out["wire"] = {{"type", "string"},
                 {"description", "an output of another node: @node for its first one, or @node.port"},
                 {"pattern", "^@[A-Za-z0-9_-]+(\\.[A-Za-z0-9_]+)?$"}};
  out["parameter"] = parameter_schema();
  out["preset"] = preset_schema();
  out["input"] = input_schema();
  out["output"] = output_schema();
  out["node"] = any_node_schema(types);
  for (const NodeType& t : types) out["node_" + t.name] = node_schema(t);
  return out;
}

ordered_json by_name(const std::string& pattern, const std::string& definition) {
  return {
      {"type", "object"}, {"propertyNames", {{"pattern", pattern}}}, {"additionalProperties", reference(definition)}};
}

/// The sections that a document and an entry of `graphs` share.
ordered_json graph_properties() {
  const ordered_json text_value = {{"type", "string"}};
  return {{"summary", text_value},
          {"help", text_value},
          {"parameters", by_name("^[A-Za-z][A-Za-z0-9_]*$", "parameter")},
          {"seed", any_of({{{"type", "integer"}, {"minimum", 0}}, reference("reference"), reference("expression")})},
          {"inputs", by_name("^[A-Za-z][A-Za-z0-9_]*$", "input")},
          {"nodes", by_name("^[A-Za-z0-9_-]+$", "node")},
          {"outputs", by_name("^[A-Za-z][A-Za-z0-9_]*$", "output")}};
}

}  // namespace

std::string json_schema(const std::vector<NodeType>& types) {
  ordered_json properties = {{"$schema", {{"type", "string"}}},
                             {"terrazzo", {{"const", document_migrations().size() + 1}}}};
  properties.update(graph_properties());
  properties["presets"] = by_name("", "preset");
  properties["graphs"] = by_name("^[A-Za-z0-9_-]+$", "graph");
  ordered_json defs = definitions(types);
  defs["graph"] = {{"type", "object"},
                   {"description", "a graph that nodes of this document can be"},
                   {"properties", graph_properties()},
                   {"required", {"nodes"}},
                   {"additionalProperties", false}};
  const ordered_json known_types = {{"properties", {{"nodes", {{"additionalProperties", known_type_schema(types)}}}}}};
  const ordered_json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                               {"title", "terrazzo graph"},
                               {"type", "object"},
                               {"properties", properties},
                               {"required", {"terrazzo", "nodes"}},
                               {"additionalProperties", false},
                               {"if", {{"required", {"graphs"}}}},
                               {"else", known_types},
                               {"$defs", defs}};
  return schema.dump(2) + '\n';
}

}  // namespace terrazzo
