#pragma once

#include <filesystem>
#include <string>

namespace terrazzo {

/// What a file is that is no image, as far as its first bytes tell: "a PDF document", "a ZIP archive", "text". Empty
/// for images, and where they tell nothing.
std::string other_content(const std::filesystem::path& path);

}  // namespace terrazzo
