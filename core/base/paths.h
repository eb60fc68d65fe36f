#pragma once

#include <filesystem>
#include <system_error>

namespace terrazzo {

/// The lexically normal path without a trailing slash, so that its last part has a name.
inline std::filesystem::path without_trailing_slash(const std::filesystem::path& path) {
  const std::filesystem::path shortest = path.lexically_normal();
  return shortest.has_filename() ? shortest : shortest.parent_path();
}

/// The canonical location of a file that is renamed to `path`. Resolves links to folders, but not a link at `path`
/// itself, since renaming replaces it.
inline std::filesystem::path place_of_file(const std::filesystem::path& path) {
  std::error_code unreadable;
  const std::filesystem::path normal = std::filesystem::absolute(path, unreadable).lexically_normal();
  const std::filesystem::path folder = std::filesystem::weakly_canonical(normal.parent_path(), unreadable);
  return unreadable ? normal : folder / normal.filename();
}

}  // namespace terrazzo
