#pragma once

#include <string>
#include <vector>

#include "graphs/text/graph.h"

/// Pictures of graphs: boxes with a node's name and type, wires from output to input, left to right.
namespace terrazzo {

/// Text for Graphviz.
std::string draw_dot(const Graph& graph);

/// What a run says about a node, for its box.
struct NodeMark {
  std::string state{};    ///< "run", "cached", "failed", ...: a key of state_colour, and a class of the box
  std::string line{};     ///< written at the bottom of the box: "run, 1.24 s"
  std::string picture{};  ///< a small picture of its result as a data URI; empty: none
};

/// A picture that needs no other program. Boxes are coloured by category and list the ports that are wired; wires are
/// coloured by the type of what they carry. Nodes of a subgraph are named by their place in it, under its path; a frame
/// is drawn around them if no other node lies between them. `marks`: one per node, or none at all. Boxes are groups of
/// the class "node" with the node's position in the graph as `data-node`; every colour that a page may want to change
/// is an attribute of an element with a class.
std::string draw_svg(const Graph& graph, const std::vector<NodeMark>& marks = {});

/// The colour that stands for a state in drawings and charts; grey if it has none.
std::string_view state_colour(std::string_view state);

}  // namespace terrazzo
