#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "runner/plan/plan.h"

namespace terrazzo {

/// What a plan goes without because nodes are certain to fail (see Stage::faults).
struct LeftOut {
  std::set<std::string> nodes;             ///< those that fail, and all that need them
  std::map<std::string, std::string> why;  ///< of those that fail, and of targets that need them: for people
  std::vector<std::string> targets;        ///< that can be made all the same
};

LeftOut left_out_of(const Plan& plan);

/// Makes the graph one without them.
void take_out(const LeftOut& left_out, Graph& graph);

}  // namespace terrazzo
