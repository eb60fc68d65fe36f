#include "graphs/tools/descriptor_json.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "graphs/text/format.h"
#include "graphs/values/convert.h"

namespace terrazzo {

using nlohmann::ordered_json;

ordered_json json_of_port(const Port& p) {
  return {{"name", p.name}, {"type", name_of(p.type)}, {"help", p.help}, {"optional", p.optional}, {"list", p.list}};
}

ordered_json json_of_param(const Param& p) {
  ordered_json out = {{"name", p.name}, {"type", name_of(p.type)}};
  if (p.fallback) out["default"] = ordered_json::parse(compact(json_of(*p.fallback)));
  if (p.min) out["min"] = *p.min;
  if (p.max) out["max"] = *p.max;
  if (!p.unit.empty()) out["unit"] = p.unit;
  if (!p.choices.empty()) out["choices"] = p.choices;
  if (p.min_count > 0) out["min_count"] = p.min_count;
  if (p.max_count > 0) out["max_count"] = p.max_count;
  out["help"] = p.help;
  return out;
}

namespace {

ordered_json json_of_step(const NodeStep& s) {
  return {{"name", s.name}, {"when", s.when}, {"help", s.help}};
}

template <typename T>
ordered_json list_of(const std::vector<T>& all, ordered_json (*json_of_one)(const T&)) {
  ordered_json out = ordered_json::array();
  for (const T& one : all) out.push_back(json_of_one(one));
  return out;
}

}  // namespace

ordered_json json_of_type(const NodeType& t) {
  ordered_json out = {{"name", t.name},
                      {"version", t.version},
                      {"category", t.category},
                      {"summary", t.summary},
                      {"help", t.help},
                      {"inputs", list_of(t.inputs, json_of_port)},
                      {"outputs", list_of(t.outputs, json_of_port)},
                      {"parameters", list_of(t.params, json_of_param)}};
  if (!t.steps.empty()) out["steps"] = list_of(t.steps, json_of_step);
  return out;
}

ordered_json json_of_value(const JsonValue& v) {
  switch (v.kind) {
    case JsonValue::Kind::null:
      return nullptr;
    case JsonValue::Kind::boolean:
      return v.boolean;
    case JsonValue::Kind::integer:
      return v.integer;
    case JsonValue::Kind::number:
      return v.number;
    case JsonValue::Kind::text:
      return v.text;
    default:
      break;
  }
  ordered_json out = v.is_object() ? ordered_json::object() : ordered_json::array();
  for (const JsonValue& item : v.items) out.push_back(json_of_value(item));
  for (const JsonMember& m : v.members) out[m.name] = json_of_value(m.value);
  return out;
}

std::vector<std::string> categories_of(const std::vector<NodeType>& types) {
  std::vector<std::string> all = {"source", "image", "analysis", "synthesis", "sink"};
  for (const NodeType& t : types)
    if (std::find(all.begin(), all.end(), t.category) == all.end()) all.push_back(t.category);
  return all;
}

}  // namespace terrazzo
