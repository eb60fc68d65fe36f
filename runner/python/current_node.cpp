#include "runner/python/current_node.h"

namespace terrazzo::python {

namespace {

thread_local NodeContext* node_of_thread = nullptr;

}  // namespace

const NodeContext* current_node() {
  return node_of_thread;
}
NodeContext* current_node_to_note() {
  return node_of_thread;
}

Computes::Computes(NodeContext& node) : before_(node_of_thread) {
  node_of_thread = &node;
}
Computes::~Computes() {
  node_of_thread = before_;
}

}  // namespace terrazzo::python
