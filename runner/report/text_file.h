#pragma once

#include <filesystem>
#include <string>

namespace terrazzo {

/// Writes all of the text or nothing: under a temporary name beside `path`, then renamed. A device or pipe is
/// written in place. Throws Error.
void write_whole_file(const std::filesystem::path& path, const std::string& text);

}  // namespace terrazzo
