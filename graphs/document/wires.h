#pragma once

#include <set>
#include <string>
#include <vector>

#include "graphs/document/levels.h"

/// The wires between the nodes of a document.
namespace terrazzo {

/// Checks every wire of a level, from its own nodes' point of view: the other node and its output exist, the type fits.
/// Wires that do not are taken away, with a problem; the others get the name of their output. Images that become
/// materials are added to `conversions`.
void check_wires(Level& level, std::vector<Problem>& problems, std::vector<Problem>& conversions);

/// Where a wire comes from, through inputs and outputs of subgraphs and through muted nodes.
struct WireSources {
  std::vector<Wire> wires;     ///< of nodes that run; several in a loop, none if an optional input is open
  std::set<std::string> open;  ///< inputs of the document itself that it ends at, and parameters that it needs
  bool is_faulty = false;      ///< something on its way has a problem, which has been reported
};

/// Follows a wire of this level. Wires that lead back to themselves are a problem of `asking`.
WireSources sources_of(const Level& level, const WireEnd& end, Diagnostics& asking);

/// Connects all nodes, once the wires of all levels have been checked. Where a subgraph's input is open, the node that
/// needs it gets a problem, or, in a graph that is looked at by itself, the name of the input in `unset`.
void connect(Levels& levels, std::vector<Problem>& problems);

/// Positions of all nodes such that every wire comes from an earlier one, as near to the document's order as that
/// allows. Each cycle is a problem that names the nodes on it.
std::vector<size_t> execution_order(const Drafts& drafts, std::vector<Problem>& problems);

/// The names of what these nodes read, directly or not; they are included if they are there.
std::set<std::string> needed_nodes(const Drafts& drafts, std::vector<std::string> names);

/// The nodes that `only` names, each by its name or that of a node that it is a part of, and what those need; all if
/// there are no names, or if one of them stands for no node.
std::set<std::string> wanted_nodes(const Drafts& drafts, const std::vector<std::string>& only);

/// These nodes, and what their expressions ask for.
std::set<std::string> asked_too(const Drafts& drafts, const std::set<std::string>& nodes);

}  // namespace terrazzo
