#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "runner/plan/plan.h"

namespace terrazzo {

/// The nodes that a plan leaves out because they are certain to fail (see Stage::faults).
struct LeftOut {
  std::set<std::string> nodes;             ///< failing nodes and all nodes that need them
  std::map<std::string, std::string> why;  ///< reasons, for failing nodes and targets that need them
  std::vector<std::string> targets;        ///< targets that can still be computed
};

LeftOut left_out_of(const Plan& plan);

/// Removes these nodes from the graph.
void take_out(const LeftOut& left_out, Graph& graph);

}  // namespace terrazzo
