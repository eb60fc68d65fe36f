#include "nodes/registry.h"

#include <algorithm>

// One line per node type: the function `NodeType <name>_node()` is defined in nodes/<name>.cpp.
#define TERRAZZO_NODES(X) X(load_map) X(load_material) X(noise) X(pattern) X(preview) X(export)

namespace terrazzo {

#define TERRAZZO_DECLARE(name) NodeType name##_node();
TERRAZZO_NODES(TERRAZZO_DECLARE)

const std::vector<NodeType>& node_types() {
#define TERRAZZO_CALL(name) name##_node(),
  static const std::vector<NodeType> types = {TERRAZZO_NODES(TERRAZZO_CALL)};
  return types;
}

const NodeType* find_node_type(std::string_view name) {
  const std::vector<NodeType>& types = node_types();
  const auto at = std::find_if(types.begin(), types.end(), [&](const NodeType& t) { return t.name == name; });
  return at == types.end() ? nullptr : &*at;
}

}  // namespace terrazzo
