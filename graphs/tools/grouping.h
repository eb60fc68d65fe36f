#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "graphs/document/subgraphs.h"
#include "graphs/text/json.h"

/// Nodes into a subgraph, and back. Comments and the order of everything else stay.
namespace terrazzo {

/// The document with some of its nodes moved into a new graph `name` of its section `graphs`, and one node of that type
/// and name in their place. What they need from outside becomes its inputs and parameters, what others read of them its
/// outputs. Throws GraphError if the document cannot be read, and Error if a graph file cannot say it.
std::string grouped(std::string_view text, const std::filesystem::path& file, const std::string& name,
                    const std::vector<std::string>& nodes);

/// The document with the nodes of a subgraph in the place of `node`, which is one. The entry of `graphs` goes once no
/// node is of that type. Throws as grouped does.
std::string ungrouped(std::string_view text, const std::filesystem::path& file, const std::string& node);

/// A document whose graph `name` lies in a file of its own, and that file's text. `type`: how the document's nodes name
/// the file.
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
