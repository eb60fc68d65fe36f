#pragma once

#include <string>
#include <vector>

#include "graphs/document/nodes.h"

/// What joins the nodes of a document.
namespace terrazzo {

/// Resolves every wire into the inputs of its node: the other node and its output exist, the type fits. Problems go to
/// the complaints of the port, which must end in `problems`. Images that become materials are added to `conversions`.
void connect(std::vector<NodeDraft>& drafts, std::vector<Problem>& problems, std::vector<Problem>& conversions);

/// Positions of all nodes such that every wire comes from an earlier one, as near to the document's order as that
/// allows. Each cycle is a problem that names the nodes on it.
std::vector<size_t> execution_order(const std::vector<NodeDraft>& drafts, std::vector<Problem>& problems);

/// The nodes, by position in the graph, that a sink reads, directly or not; sinks included.
std::vector<bool> needed_nodes(const Graph& graph);

}  // namespace terrazzo
