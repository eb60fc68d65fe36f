#pragma once

#include <filesystem>
#include <string>

namespace terrazzo {

/// Advice on a path in Windows spelling, or one whose backslashes JSON has read as escapes: `write "scans/brick"`.
/// Empty if the spelling is fine, or if such a file exists relative to `base`.
std::string path_advice(const std::filesystem::path& base, const std::string& text);

}  // namespace terrazzo
