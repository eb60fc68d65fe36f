#pragma once

#include <string>

#include "graphs/document/graph.h"

/// Pictures of graphs: boxes with a node's name and type, wires from output to input, left to right.
namespace terrazzo {

/// Text for Graphviz.
std::string draw_dot(const Graph& graph);

/// A picture that needs no other program. Boxes are coloured by category and list the ports that are wired; wires are
/// coloured by the type of what they carry.
std::string draw_svg(const Graph& graph);

}  // namespace terrazzo
