#pragma once

#include <filesystem>
#include <string>

namespace terrazzo {

/// What to do about a path that is written as on Windows, or whose backslashes a JSON text has taken for escapes:
/// `write "scans/brick"`. Empty if it is written as here, or if what it names, relative to `base`, has such a name.
std::string path_advice(const std::filesystem::path& base, const std::string& text);

}  // namespace terrazzo
