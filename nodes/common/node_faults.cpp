#include "nodes/common/node_faults.h"

#include <algorithm>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/text.h"

namespace terrazzo {

namespace {

bool is_plain_name(const std::string& name) {
  return !name.empty() && !is_digit(name.front()) && std::ranges::all_of(name, is_word);
}

}  // namespace

std::string fault_of_node_type(const NodeType& t) {
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

}  // namespace terrazzo
