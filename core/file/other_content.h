#pragma once

#include <filesystem>
#include <string>

namespace terrazzo {

/// Describes the content of a file that is no image, by its first bytes: "a PDF document", "a ZIP archive", "text".
/// Empty for images and unknown content.
std::string other_content(const std::filesystem::path& path);

}  // namespace terrazzo
