#pragma once

#include <filesystem>

namespace terrazzo {

/// Whether a path is the folder or lies below it. Compares names only; resolve links first.
bool lies_in(const std::filesystem::path& folder, const std::filesystem::path& path);

}  // namespace terrazzo
