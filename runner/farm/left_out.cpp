#include "runner/farm/left_out.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace terrazzo {

LeftOut left_out_of(const Plan& plan) {
  LeftOut out;
  std::map<int, std::string> causes;  // the failing node, by left-out stage
  for (size_t i = 0; i < plan.stages.size(); i++) {
    const Stage& s = plan.stages[i];
    const std::string& name = s.node->name;
    const auto lost = std::ranges::find_if(s.sources, [&](int source) { return causes.contains(source); });
    if (!s.faults.empty()) {
      causes.emplace(int(i), name);
      out.why.emplace(name, fmt::format("{}", fmt::join(s.faults, "\n")));
    } else if (lost != s.sources.end()) {
      const std::string& cause = causes.emplace(int(i), causes.at(*lost)).first->second;
      if (s.target) out.why.emplace(name, fmt::format("node \"{}\" needs \"{}\", which would fail", name, cause));
    } else {
      if (s.target) out.targets.push_back(name);
      continue;
    }
    out.nodes.insert(name);
  }
  return out;
}

void take_out(const LeftOut& left_out, Graph& graph) {
  std::erase_if(graph.nodes, [&](const GraphNode& n) { return left_out.nodes.contains(n.name); });
}

}  // namespace terrazzo
