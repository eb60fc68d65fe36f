#include "graphs/text/given_inputs.h"

namespace terrazzo {

std::vector<std::string> give_inputs(JsonValue& document, const std::map<std::string, const NodeType*>& types) {
  std::vector<std::string> used;
  JsonValue *inputs = document.find("inputs"), *nodes = document.find("nodes");
  for (const auto& [name, type] : types) {
    if (!inputs || !inputs->find(name) || !nodes || !nodes->is_object()) continue;
    std::erase_if(inputs->members, [&, name = name](const JsonMember& m) { return m.name == name; });
    JsonValue node = JsonValue::empty_object();
    node.set("type", JsonValue::of(type->name));
    nodes->set(name, std::move(node));
    used.push_back(name);
  }
  if (inputs && inputs->members.empty())
    std::erase_if(document.members, [](const JsonMember& m) { return m.name == "inputs"; });
  return used;
}

}  // namespace terrazzo
