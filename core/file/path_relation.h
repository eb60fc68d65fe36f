#pragma once

#include <filesystem>

namespace terrazzo {

/// Whether a path names the folder, or something in it at any depth. By the names alone: resolve links before.
bool lies_in(const std::filesystem::path& folder, const std::filesystem::path& path);

}  // namespace terrazzo
