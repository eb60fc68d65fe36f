#pragma once

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

}  // namespace terrazzo
