#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "graphs/values/parameters.h"
#include "graphs/values/substitution.h"

/// `foreach`: one node, or subgraph, for each of several files, folders, values or rows of a table.
///
///     "foreach": {"folders": "scans/*", "as": "scan"}
namespace terrazzo {

/// One round of a loop.
struct LoopRound {
  std::string label;                      ///< unlike that of all others: "brick"
  std::vector<GraphParameter> variables;  ///< scan, scan_name and scan_index; of a table its columns
};

/// Something that can be set: a parameter of the graph (`node` is empty) or of a node, or what a loop goes over.
struct Settable {
  std::string node{};  ///< with its path
  std::string name;    ///< "foreach" of a loop
  std::string path{};  ///< its value, if that is a path
};
/// By path parameter of a node: what else can be set that its value is made from.
using SetBy = std::map<std::string, std::vector<Settable>>;

/// What a loop was made from.
struct LoopSource {
  std::string node{};          ///< its name, with its path
  std::string kind;            ///< "files", "folders" or "table"
  std::filesystem::path path;  ///< of files and folders what they are to be named like; absolute
  std::string as;
  std::vector<std::string> names{};  ///< of the files and folders found, in the order of the rounds
  std::vector<Settable> set_by{};    ///< what can be set that it was made from
};

/// The rounds that `loop` describes; relative paths lie in `folder`. Files that it read, and folders that it listed,
/// are added to `made_from`, without the node's name. Empty after a problem, or if something is lacking, which is added
/// to `lacking`.
std::optional<std::vector<LoopRound>> read_loop(const JsonValue& loop, const std::filesystem::path& folder,
                                                Substitution& substitution, Diagnostics& diagnostics, Lacking& lacking,
                                                std::vector<LoopSource>& made_from);

}  // namespace terrazzo
