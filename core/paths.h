#pragma once

#include <filesystem>

namespace terrazzo {

/// The path in its shortest form and without a slash at its end, so that its last part has a name.
inline std::filesystem::path without_trailing_slash(const std::filesystem::path& path) {
  const std::filesystem::path shortest = path.lexically_normal();
  return shortest.has_filename() ? shortest : shortest.parent_path();
}

}  // namespace terrazzo
