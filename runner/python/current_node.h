#pragma once

#include "core/node/node.h"

namespace terrazzo::python {

/// The node that this thread is computing; null outside of nodes.
const NodeContext* current_node();
NodeContext* current_node_to_note();

/// While it lives, makes `node` the current node of this thread.
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
