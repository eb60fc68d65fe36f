#pragma once

#include <vector>

#include "graphs/document/level.h"

namespace terrazzo {

/// Tells every path parameter and every port (see GraphNode::files_by) from which of the document's own parameters its
/// files are: those that can be set. `order` is topological.
void trace_files(Drafts& drafts, const std::vector<size_t>& order);

}  // namespace terrazzo
