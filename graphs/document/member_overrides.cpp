#include "graphs/document/member_overrides.h"

#include <map>
#include <set>

#include "graphs/values/convert.h"

namespace terrazzo {

void merge_members(std::vector<Override>& overrides, const std::vector<GraphParameter>& parameters,
                   const NodeTypes& nodes, std::vector<Problem>& problems) {
  std::set<std::string> node_names;
  for (const auto& [name, type] : nodes) node_names.insert(name);
  std::map<std::string, const GraphParameter*> map_parameters;
  for (const GraphParameter& p : parameters)
    if (!node_names.contains(p.param.name) &&
        (p.param.type == ParamType::number_map || p.param.type == ParamType::text_map))
      map_parameters.emplace(p.param.name, &p);
  struct Merged {
    JsonValue map;
    Override* last = nullptr;  ///< receives the merged map
  };
  std::map<std::string, Merged> maps;
  for (Override& o : overrides) {
    const std::string name = o.node.empty() ? o.name : o.node;
    const auto p = map_parameters.find(name);
    if (p == map_parameters.end()) continue;
    const std::optional<ParamValue>& value = p->second->value;
    const auto [at, is_new] =
        maps.try_emplace(name, Merged{value ? json_of(*value) : JsonValue::empty_object(), nullptr});
    Merged& merged = at->second;
    if (o.node.empty()) {
      merged = {o.json_for(p->second->param), nullptr};
      continue;
    }
    std::optional<JsonValue> with = with_member(std::move(merged.map), o.name, o, problems);
    merged = {with ? std::move(*with) : JsonValue::empty_object(), with ? &o : nullptr};
    o.json = JsonValue::empty_object();
    o.name = name;
    o.node.clear();
  }
  for (auto& [name, merged] : maps)
    if (merged.last) merged.last->json = std::move(merged.map);
}

}  // namespace terrazzo
