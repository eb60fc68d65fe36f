#pragma once

#include <string>

#include "graphs/text/graph.h"

namespace terrazzo {

/// A node for a graph built in code. Missing parameters take their defaults. Throws std::logic_error if the type does
/// not exist, or if a parameter without a default is missing.
GraphNode memory_node(const std::string& name, const std::string& type, const Params& given);

/// A node that reads a material from a folder of maps, or one map from an image file, whose name may tell which map it
/// is.
GraphNode reading_node(const std::string& name, const std::filesystem::path& path);

}  // namespace terrazzo
