#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "runner/cli/exemplar/exemplar_inspection.h"
#include "runner/terminal/usage.h"

namespace terrazzo {

/// A graph to start from.
struct NewGraph {
  int exit_code = exit_done;  ///< else there is no graph, and messages have said why
  std::string text{};
  std::vector<std::string> findings{};  ///< lines for the user
};

/// The stock graph for an exemplar if none is named: for a folder of maps, or for a picture.
std::string_view stock_graph_like(const ExemplarFlags& exemplar);

/// Inspects an exemplar and adapts the stock graph `like` to it. Paths in it are those for a graph file at `out`.
/// Prints warnings. Throws UsageError and GraphError.
NewGraph new_graph(const ExemplarFlags& exemplar, const std::filesystem::path& out, const std::string& like,
                   const std::atomic<bool>& cancelled);

}  // namespace terrazzo
