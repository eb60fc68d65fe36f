#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graphs/text/json.h"

namespace terrazzo {

/// Reads the text of a document, or of the stock graph that the path names ("stock:material"). Throws GraphError if the
/// file is missing, unreadable or far too large. `what`: the kind of file, for messages.
std::string read_document(const std::filesystem::path& path, const std::string& what = "graph file");

/// Reads a JSON document beside a graph. Errors become problems with its name, line and column.
std::optional<JsonValue> read_json_document(const std::filesystem::path& path, const std::string& what,
                                            std::vector<Problem>& problems);

}  // namespace terrazzo
