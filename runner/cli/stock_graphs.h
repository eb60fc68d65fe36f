#pragma once

#include <string_view>

namespace terrazzo {

/// The text of graphs/<name>.json, which is part of the program. Throws std::logic_error if there is no such graph.
std::string_view stock_graph(std::string_view name);

}  // namespace terrazzo
