#pragma once

#include <set>
#include <string>
#include <vector>

#include "graphs/document/nodes.h"

/// The wires between the nodes of a document.
namespace terrazzo {

/// Resolves every wire into the inputs of its node: the other node and its output exist, the type fits. Problems go to
/// the diagnostics of the port, which must end in `problems`. Images that become materials are added to `conversions`.
void connect(std::vector<NodeDraft>& drafts, std::vector<Problem>& problems, std::vector<Problem>& conversions);

/// Positions of all nodes such that every wire comes from an earlier one, as near to the document's order as that
/// allows. Each cycle is a problem that names the nodes on it.
std::vector<size_t> execution_order(const std::vector<NodeDraft>& drafts, std::vector<Problem>& problems);

/// The names of what these nodes read, directly or not; they are included if they are there.
std::set<std::string> needed_nodes(const std::vector<NodeDraft>& drafts, std::vector<std::string> names);

}  // namespace terrazzo
