#include "graphs/document/left_out.h"

#include <algorithm>

namespace terrazzo {

bool is_complete(const NodeDraft& draft) {
  const GraphNode& node = draft.node;
  if (!node.type || node.params.size() < node.type->params.size() || !draft.unset.empty()) return false;
  return std::ranges::none_of(draft.ports, [](const PortWires& p) { return p.has_faults; });
}

std::set<std::string> nodes_left(const Drafts& drafts, const std::vector<size_t>& order,
                                 const std::set<std::string>& wanted, const std::set<std::string>& faulty) {
  std::set<std::string> out;
  for (const size_t i : order) {
    const NodeDraft& d = drafts[i];
    const auto is_left = [&](const auto& input) {
      return std::ranges::all_of(input.second, [&](const Wire& w) { return out.contains(w.node); });
    };
    const bool can_be_made =
        wanted.contains(d.node.name) && is_complete(d) && std::ranges::all_of(d.node.inputs, is_left);
    if (can_be_made || faulty.contains(d.node.name)) out.insert(d.node.name);
  }
  return out;
}

}  // namespace terrazzo
