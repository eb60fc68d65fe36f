#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

/// How large a cache may become: what the command line says, else $TERRAZZO_CACHE_SIZE, else the line `size = 20G` in
/// settings.txt in the cache's folder, else 10 GiB.
namespace terrazzo {

struct CacheLimit {
  uint64_t bytes = 0;
  std::string from;  ///< "TERRAZZO_CACHE_SIZE", "/.../settings.txt", "the default"
};

/// What the environment and the folder's settings say. Throws Error if they cannot be understood.
CacheLimit cache_limit(const std::filesystem::path& folder);

/// Bytes from "512M", "2G", "1.5 GiB"; nullopt if it is none of these.
std::optional<uint64_t> size_from(std::string_view text);
/// The end of a message on a text that is none.
inline constexpr std::string_view size_help =
    "takes a number with a unit, such as 512M or 2G (K, M, G, T; 1K = 1024 bytes)";

}  // namespace terrazzo
