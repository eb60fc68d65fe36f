#pragma once

#include <set>
#include <string>
#include <vector>

#include "graphs/document/levels.h"

/// The wires between the nodes of a document.
namespace terrazzo {

/// Checks every wire of a level: its source node and output exist and the type fits. Removes faulty wires, with a
/// problem; fills in the output names of the others. Adds conversions from image to material to `conversions`.
void check_wires(Level& level, std::vector<Problem>& problems, std::vector<Problem>& conversions);

/// Why a wire does not go into `port` of the node `reader` of this graph, and what would fit; empty if it does, or if a
/// type is unknown.
std::string wire_fault(const Subgraph& graph, const WireEnd& end, const std::string& reader, const Port& port);

/// The sources of a wire, resolved through inputs and outputs of subgraphs and through muted nodes.
struct WireSources {
  std::vector<Wire> wires;     ///< outputs of nodes that run; several for a loop, none if an optional input is open
  std::set<std::string> open;  ///< inputs of the document where it ends, and parameters without a value that it needs
  bool is_faulty = false;      ///< a problem along the way has been reported
};

/// Follows a wire of this level. Reports cycles to `asking`.
WireSources sources_of(const Level& level, const WireEnd& end, Diagnostics& asking);

/// Connects all nodes after check_wires of all levels. If an input of a subgraph is open, reports a problem for the
/// node that needs it; if an input of the document itself is open, adds its name to the node's `unset`.
void connect(Levels& levels, std::vector<Problem>& problems);

/// A topological order of all nodes, as close to the document's order as possible. Reports each cycle as a problem that
/// names its nodes.
std::vector<size_t> execution_order(const Drafts& drafts, std::vector<Problem>& problems);

/// The names of these nodes, as far as they exist, and of all their direct and indirect sources.
std::set<std::string> needed_nodes(const Drafts& drafts, std::vector<std::string> names);

/// The nodes that `only` names, by their own name or that of an enclosing node, and all their sources. All nodes if
/// `only` is empty or contains an unknown name.
std::set<std::string> wanted_nodes(const Drafts& drafts, const std::vector<std::string>& only);

/// These nodes, and the nodes that their expressions query.
std::set<std::string> asked_too(const Drafts& drafts, const std::set<std::string>& nodes);

}  // namespace terrazzo
