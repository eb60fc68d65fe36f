#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

/// The size limit of a cache: from the command line, else $TERRAZZO_CACHE_SIZE, else the line `size = 20G` of
/// settings.txt in the cache's folder, else 10 GiB.
namespace terrazzo {

struct CacheLimit {
  uint64_t bytes = 0;
  std::string from;  ///< "TERRAZZO_CACHE_SIZE", "/.../settings.txt", "the default"
};

/// The limit from the environment or the folder's settings, else the default. Throws Error if they are invalid.
CacheLimit cache_limit(const std::filesystem::path& folder);

/// Parses "512M", "2G" or "1.5 GiB" to bytes; nullopt if invalid.
std::optional<uint64_t> size_from(std::string_view text);
/// The end of a message about an invalid size.
inline constexpr std::string_view size_help =
    "takes a number with a unit, such as 512M or 2G (K, M, G, T; 1K = 1024 bytes)";

}  // namespace terrazzo
