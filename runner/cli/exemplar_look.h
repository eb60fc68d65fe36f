#pragma once

#include <string>

#include "graphs/document/graph.h"

/// How commands look at an exemplar before they choose.
namespace terrazzo {

/// Reads the maps of a folder ("exemplar"), weights them ("weighted"), and looks for what repeats ("lattice") and for
/// elements ("elements"), as graphs/material.json does. `name`: which material of the folder; empty: the only one.
Graph looking_graph(const std::string& folder, const std::string& name);

}  // namespace terrazzo
