#pragma once

#include <string>
#include <vector>

#include "graphs/text/graph.h"

/// Draws graphs: boxes with the nodes' names and types, and wires from left to right.
namespace terrazzo {

/// The graph in Graphviz's DOT language.
std::string draw_dot(const Graph& graph);

/// The result of a run for a node, shown in its box.
struct NodeMark {
  std::string state{};    ///< "run", "cached", "failed", ...: a key of state_colour, and a class of the box
  std::string line{};     ///< text at the bottom of the box: "run, 1.24 s"
  std::string picture{};  ///< a thumbnail of its result as a data URI; empty: none
};

/// The graph as a self-contained SVG. Boxes are coloured by category and list the connected ports; wires are coloured
/// by value type. A subgraph's nodes show its path and their name in it; a frame surrounds them if no other node lies
/// between them. `marks`: one per node, or empty. Each box is a group of class "node" with the node's index in
/// `data-node`; every colour that a page may restyle is an attribute of an element with a class.
std::string draw_svg(const Graph& graph, const std::vector<NodeMark>& marks = {});

/// The colour of a state in drawings and charts; grey for others.
std::string_view state_colour(std::string_view state);

}  // namespace terrazzo
