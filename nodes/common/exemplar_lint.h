#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace terrazzo {

/// For NodeType::lint of nodes that read an exemplar's colours: is most of it one colour, or lit from a side? Each
/// message begins with `subject`. Reads the file; what is wrong with it is left to others.
std::vector<std::string> lint_of_colour(const std::string& subject, const std::filesystem::path& file);

}  // namespace terrazzo
