#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "graphs/document/subgraphs.h"
#include "graphs/text/json.h"

/// Moves nodes into a subgraph, and back. Keeps comments and the order of everything else.
namespace terrazzo {

/// Moves nodes into a new graph `name` in the section `graphs` and puts a node of that type and name in their place.
/// Wires and parameters from outside become its inputs and parameters; outputs that others read become its outputs.
/// Throws GraphError if the document is invalid, and Error if the result cannot be expressed in a graph file.
std::string grouped(std::string_view text, const std::filesystem::path& file, const std::string& name,
                    const std::vector<std::string>& nodes);

/// Replaces `node`, a use of a subgraph, by the subgraph's nodes. Removes the entry of `graphs` once no node uses it.
/// Throws as grouped.
std::string ungrouped(std::string_view text, const std::filesystem::path& file, const std::string& node);

/// Moves the graph `name` into a file of its own: the changed document, and the file's text. `type`: the type by which
/// the document's nodes refer to the file.
struct GraphInFile {
  std::string document, graph;
};
GraphInFile moved_to_file(std::string_view text, const std::string& file, const std::string& name,
                          const std::string& type);

namespace detail {
void group(JsonValue& document, const Subgraph& main, const std::string& name, const std::vector<std::string>& nodes);
void ungroup(JsonValue& document, const Subgraph& graph, const std::string& node);
}  // namespace detail

}  // namespace terrazzo
