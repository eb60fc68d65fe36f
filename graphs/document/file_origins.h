#pragma once

#include <set>
#include <string>
#include <vector>

#include "graphs/document/level.h"

namespace terrazzo {

/// Tells every path parameter and every port (see GraphNode::files_by) from which of the document's own parameters its
/// files are: those that can be set. `order` is topological.
void trace_files(Drafts& drafts, const std::vector<size_t>& order);

/// Tells every path parameter what else can be set that its value is made from (NodeDraft::set_by).
void trace_settables(Drafts& drafts);

/// What can be set, in this level and those around it, that these parameters of the level are made from, themselves
/// included.
std::vector<Settable> settables_behind(const Level& level, const std::set<std::string>& parameters);

}  // namespace terrazzo
