#pragma once

#include <filesystem>
#include <system_error>

namespace terrazzo {

/// The path in its shortest form and without a slash at its end, so that its last part has a name.
inline std::filesystem::path without_trailing_slash(const std::filesystem::path& path) {
  const std::filesystem::path shortest = path.lexically_normal();
  return shortest.has_filename() ? shortest : shortest.parent_path();
}

/// Where a file lies that is renamed to `path`: the same for all ways to say it, through whatever links to folders. A
/// link of that very name is not followed, since renaming takes its place.
inline std::filesystem::path place_of_file(const std::filesystem::path& path) {
  std::error_code unreadable;
  const std::filesystem::path normal = std::filesystem::absolute(path, unreadable).lexically_normal();
  const std::filesystem::path folder = std::filesystem::weakly_canonical(normal.parent_path(), unreadable);
  return unreadable ? normal : folder / normal.filename();
}

}  // namespace terrazzo
