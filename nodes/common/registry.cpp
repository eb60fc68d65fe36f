#include "nodes/common/registry.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>

#include <fmt/format.h>

#include "core/base/error.h"
#include "nodes/common/node_faults.h"

namespace terrazzo {

#define TERRAZZO_NODE(name) NodeType name##_node();
#include "nodes/common/node_list.inc"
#undef TERRAZZO_NODE

namespace {

using Types = std::vector<NodeType>;

/// Each registration makes a new list; graphs that hold descriptors of an older one keep them.
class Registry {
 public:
  Registry() {
    lists_.push_back(std::make_unique<Types>(Types{
#define TERRAZZO_NODE(name) name##_node(),
#include "nodes/common/node_list.inc"
#undef TERRAZZO_NODE
    }));
    now_ = lists_.back().get();
  }
  const Types& now() const {
    return *now_;
  }
  void add(NodeType type) {
    const std::lock_guard lock(mutex_);
    auto next = std::make_unique<Types>(*now_.load());
    const auto at = std::ranges::find(*next, type.name, &NodeType::name);
    if (at == next->end())
      next->push_back(std::move(type));
    else if (at->origin.name.empty() || at->origin.name != type.origin.name)
      throw Error(fmt::format("the node type \"{}\" of {} already exists, from {}", type.name, type.origin.name,
                              at->origin.name.empty() ? "terrazzo" : at->origin.name));
    else
      *at = std::move(type);
    lists_.push_back(std::move(next));
    now_ = lists_.back().get();
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Types>> lists_;
  std::atomic<const Types*> now_ = nullptr;
};

Registry& registry() {
  static Registry all;
  return all;
}

}  // namespace

const std::vector<NodeType>& node_types() {
  return registry().now();
}

const NodeType* find_node_type(std::string_view name) {
  const std::vector<NodeType>& types = node_types();
  const auto at = std::find_if(types.begin(), types.end(), [&](const NodeType& t) { return t.name == name; });
  return at == types.end() ? nullptr : &*at;
}

void register_node_type(NodeType type) {
  if (const std::string fault = fault_of_node_type(type); !fault.empty())
    throw Error(fmt::format("the node type \"{}\" cannot be registered: {}", type.name, fault));
  registry().add(std::move(type));
}

}  // namespace terrazzo
