#pragma once

#include "core/node/node.h"

namespace terrazzo::python {

/// The node that this thread computes; null outside of nodes.
const NodeContext* current_node();
NodeContext* current_node_to_note();

/// Makes a node the one that this thread computes, for as long as it lives.
class Computes {
 public:
  explicit Computes(NodeContext& node);
  ~Computes();
  Computes(const Computes&) = delete;
  Computes& operator=(const Computes&) = delete;

 private:
  NodeContext* before_;
};

}  // namespace terrazzo::python
