#include "nodes/common/registry.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/base/text.h"

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
      throw Error(fmt::format("the node type \"{}\" of {} is already there, from {}", type.name, type.origin.name,
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

bool is_plain_name(const std::string& name) {
  return !name.empty() && !is_digit(name.front()) && std::ranges::all_of(name, is_word);
}

/// What is wrong with a descriptor; empty if nothing is.
std::string fault_of(const NodeType& t) {
  static const std::vector<std::string> categories = {"source", "image", "analysis", "synthesis", "sink"};
  if (!is_plain_name(t.name)) return "its name must begin with a letter and have only letters, digits and _";
  if (t.origin.name.empty()) return "it does not say where it comes from";
  if (!t.compute) return "it has no compute function";
  if (std::ranges::find(categories, t.category) == categories.end())
    return fmt::format("its category is \"{}\"; expected {}", t.category, fmt::join(categories, ", "));
  if (t.outputs.empty() && !t.is_sink()) return "it has no output and is no sink";
  std::set<std::string> names = {"type", "comment", "foreach", "mute"};
  for (const Port& p : t.inputs)
    if (!is_plain_name(p.name) || !names.insert(p.name).second)
      return fmt::format("the name of its input \"{}\" is not valid, or taken", p.name);
  for (const Param& p : t.params)
    if (!is_plain_name(p.name) || !names.insert(p.name).second)
      return fmt::format("the name of its parameter \"{}\" is not valid, or taken", p.name);
  return "";
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
  if (const std::string fault = fault_of(type); !fault.empty())
    throw Error(fmt::format("the node type \"{}\" cannot be registered: {}", type.name, fault));
  registry().add(std::move(type));
}

}  // namespace terrazzo
