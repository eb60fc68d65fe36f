#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graphs/document/parameters.h"
#include "graphs/document/substitution.h"

/// `foreach`: one node, or subgraph, for each of several files, folders, values or rows of a table.
///
///     "foreach": {"folders": "scans/*", "as": "scan"}
namespace terrazzo {

/// One round of a loop.
struct LoopRound {
  std::string label;                      ///< unlike that of all others: "brick"
  std::vector<GraphParameter> variables;  ///< scan, scan_name and scan_index; of a table its columns
};

/// The rounds that `loop` describes; relative paths lie in `folder`. Files that it read, and folders that it listed,
/// are added to `made_from`. Empty after a problem, or if something is lacking, which is added to `lacking`.
std::optional<std::vector<LoopRound>> read_loop(const JsonValue& loop, const std::filesystem::path& folder,
                                                Substitution& substitution, Diagnostics& diagnostics, Lacking& lacking,
                                                std::vector<std::filesystem::path>& made_from);

}  // namespace terrazzo
