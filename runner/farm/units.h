#pragma once

#include <set>
#include <string>
#include <vector>

#include "runner/plan/plan.h"

/// Splits a plan into units that different machines can run.
namespace terrazzo {

/// Stages that run in one task. It loads other units' results from the cache and recomputes fast stages itself.
struct Unit {
  std::string name;                  ///< name of its last node
  std::vector<std::string> nodes;    ///< all its nodes, in the plan's order
  std::vector<std::string> targets;  ///< nodes whose results other units or the user need
  std::vector<std::string> needs;    ///< units that must run first
  bool is_wanted = false;            ///< requested by the user; other units run only if a wanted one needs them
  double seconds = 0;                ///< from earlier runs of the graph, or estimated; 0 if fully cached
  Digest kind;  ///< units of one kind cost about the same: equal types, sizes, choices and input sizes
};

/// Two branches of a unit become units of their own if both take at least this long. Trades the start of a task, which
/// takes seconds on a busy cluster, against idle machines. Not measured: it depends on the cluster.
inline constexpr double seconds_worth_a_task = 30;

/// Splits all needed stages of a plan into units, in a valid order of execution. A slow stage that several units read
/// becomes its own unit, so that it runs once; a stage that only one unit reads is part of that unit. The result does
/// not depend on what is cached.
std::vector<Unit> units_of(const Plan& plan);

/// The nodes of a plan whose results are in the cache or, unchanged, in their files.
std::set<std::string> made_nodes(const Plan& plan);
/// Whether all targets of the unit are in `made`.
bool is_done(const Unit& unit, const std::set<std::string>& made);

/// For each unit, whether it must run: it is not done, and is wanted or needed by a unit that must run.
std::vector<bool> due(const std::vector<Unit>& units, const Plan& plan);

}  // namespace terrazzo
