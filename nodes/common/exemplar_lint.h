#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace terrazzo {

/// For NodeType::lint of nodes that read an exemplar's colours: warns if most of it has one colour, if it is lit
/// from one side, or if it shows something only once. Each message begins with `subject`. Reads the file and ignores
/// errors in it.
std::vector<std::string> lint_of_colour(const std::string& subject, const std::filesystem::path& file);

}  // namespace terrazzo
