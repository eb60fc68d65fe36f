#pragma once

#include <set>
#include <string>
#include <vector>

#include "graphs/document/level.h"

namespace terrazzo {

/// Records for every path parameter and port which of the document's own parameters its files come from
/// (GraphNode::files_by). `order` is topological.
void trace_files(Drafts& drafts, const std::vector<size_t>& order);

/// Records for every path parameter which settable values its own value is derived from (NodeDraft::set_by).
void trace_settables(Drafts& drafts);

/// The settable values, in this level and enclosing ones, that these parameters of the level are derived from,
/// including themselves.
std::vector<Settable> settables_behind(const Level& level, const std::set<std::string>& parameters);

}  // namespace terrazzo
