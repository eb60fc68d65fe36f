#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace terrazzo {

/// A graph that comes with the program.
struct StockGraph {
  std::string_view name;  ///< "material"
  std::string_view text;  ///< of graphs/material.json
};

/// All of them, by name.
const std::vector<StockGraph>& stock_graphs();

/// The text of graphs/<name>.json. Throws std::logic_error if there is no such graph.
std::string_view stock_graph(std::string_view name);

/// Stands in place of a graph file's path, and as a node type: "stock:material".
inline constexpr std::string_view stock_prefix = "stock:";
/// Whether a path or a node type names a stock graph, be there one or not.
bool is_stock(std::string_view path);
/// The text of the graph that the path or type names. Throws Error, which suggests a name.
std::string_view named_stock_graph(std::string_view path);

}  // namespace terrazzo
