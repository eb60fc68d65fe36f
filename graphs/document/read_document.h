#pragma once

#include <filesystem>
#include <string>

#include "graphs/document/problem.h"

namespace terrazzo {

/// The text of a document. Throws GraphError if there is none, it cannot be read, or it is absurdly large; `what` it is
/// says the message.
std::string read_document(const std::filesystem::path& path, const std::string& what = "graph file");

}  // namespace terrazzo
