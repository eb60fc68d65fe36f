#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "graphs/values/parameters.h"
#include "graphs/values/substitution.h"

/// `foreach`: repeats a node or subgraph for each of several files, folders, values or table rows.
///
///     "foreach": {"folders": "scans/*", "as": "scan"}
namespace terrazzo {

/// One iteration of a loop.
struct LoopIteration {
  std::string label;                      ///< unique in the loop: "brick"
  std::vector<GraphParameter> variables;  ///< scan, scan_name and scan_index; for a table its columns
};

/// A settable value: a parameter of the graph (`node` is empty) or of a node, or a loop's source.
struct Settable {
  std::string node{};  ///< with its level's path
  std::string name;    ///< "foreach" for a loop's source
  std::string path{};  ///< its value, if that is a path
};
/// By path parameter of a node: the settable values that it is derived from.
using SetBy = std::map<std::string, std::vector<Settable>>;

/// The files or folders that a loop iterates over.
struct LoopSource {
  std::string node{};          ///< the node's name, with its level's path
  std::string kind;            ///< "files", "folders" or "table"
  std::filesystem::path path;  ///< for files and folders their pattern; absolute
  std::string as;
  std::vector<std::string> names{};  ///< of the files and folders found, in the order of iteration
  std::vector<Settable> set_by{};    ///< the settable values that it is derived from
};

/// The iterations that `loop` describes; relative paths start at `folder`. Adds files that it read and folders that it
/// listed to `made_from`, without the node's name. Nullopt after a problem, or if a value is missing, which is added to
/// `lacking`.
std::optional<std::vector<LoopIteration>> read_loop(const JsonValue& loop, const std::filesystem::path& folder,
                                                    Substitution& substitution, Diagnostics& diagnostics,
                                                    Lacking& lacking, std::vector<LoopSource>& made_from);

}  // namespace terrazzo
