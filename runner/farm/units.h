#pragma once

#include <set>
#include <string>
#include <vector>

#include "runner/plan/plan.h"

/// A plan in pieces that different machines can make.
namespace terrazzo {

/// Some stages that one task makes. What it needs of other units it finds in the cache; what is quick it makes itself.
struct Unit {
  std::string name;                  ///< of its last node
  std::vector<std::string> nodes;    ///< all that it makes, in the plan's order
  std::vector<std::string> targets;  ///< those of them whose results others need, or the user
  std::vector<std::string> needs;    ///< units that come before it
  bool is_wanted = false;            ///< the user asked for it; others are made only for those
  double seconds = 0;                ///< as earlier runs of the graph took, or guessed; 0 if all of it is cached
  Digest kind;  ///< units of one kind cost about the same: same types, sizes, choices, inputs as large
};

/// Branches of a unit that both take at least this long become units of their own. Trades the start of a task, which
/// takes seconds on a busy cluster, against machines that stand idle; not measured: it depends on the cluster.
inline constexpr double seconds_worth_a_task = 30;

/// All needed stages of a plan in units, in an order in which they can be made. A slow stage that several units read is
/// a unit of its own, so that it is made once; what one unit alone reads is part of that. Whether something is cached
/// makes no difference.
std::vector<Unit> units_of(const Plan& plan);

/// The nodes of a plan whose results are in the cache, or in their files, unchanged.
std::set<std::string> made_nodes(const Plan& plan);
/// Whether everything that others need of the unit is among them.
bool is_done(const Unit& unit, const std::set<std::string>& made);

/// Of each unit, whether it has to be made: it is not done, and is wanted or needed by one that has to be made.
std::vector<bool> due(const std::vector<Unit>& units, const Plan& plan);

}  // namespace terrazzo
