#include "nodes/common/registry.h"

#include <algorithm>

namespace terrazzo {

#define TERRAZZO_NODE(name) NodeType name##_node();
#include "nodes/common/node_list.inc"
#undef TERRAZZO_NODE

const std::vector<NodeType>& node_types() {
  static const std::vector<NodeType> types = {
#define TERRAZZO_NODE(name) name##_node(),
#include "nodes/common/node_list.inc"
#undef TERRAZZO_NODE
  };
  return types;
}

const NodeType* find_node_type(std::string_view name) {
  const std::vector<NodeType>& types = node_types();
  const auto at = std::find_if(types.begin(), types.end(), [&](const NodeType& t) { return t.name == name; });
  return at == types.end() ? nullptr : &*at;
}

}  // namespace terrazzo
