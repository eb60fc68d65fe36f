#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graphs/text/json.h"

namespace terrazzo {

/// The text of a document. Throws GraphError if there is none, it cannot be read, or it is absurdly large; `what` it is
/// says the message.
std::string read_document(const std::filesystem::path& path, const std::string& what = "graph file");

/// A JSON document beside a graph. What is wrong with it becomes problems, with its name, line and column.
std::optional<JsonValue> read_json_document(const std::filesystem::path& path, const std::string& what,
                                            std::vector<Problem>& problems);

}  // namespace terrazzo
