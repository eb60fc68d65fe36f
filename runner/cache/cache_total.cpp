#include "runner/cache/cache_total.h"

#include <fmt/format.h>

#include "core/file/atomic_file.h"
#include "runner/cache/cache_folder.h"

namespace terrazzo {

namespace {

constexpr int64_t believed_ns = 24 * 3600 * ns_per_second;

}  // namespace

std::optional<CacheTotal> read_total(const std::filesystem::path& path) {
  try {
    const auto bytes = CacheFolder::read(path);
    if (!bytes) return std::nullopt;
    const CacheTotal total = total_from_bytes(*bytes);
    const int64_t age = now_ns() - total.counted_ns;
    return age >= 0 && age < believed_ns ? std::optional(total) : std::nullopt;
  } catch (const Error&) {
    return std::nullopt;
  }
}

void write_total(const std::filesystem::path& path, const CacheTotal& total, const std::string& owner) {
  const std::vector<uint8_t> bytes = total_to_bytes(total);
  try {
    write_whole_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                     path.parent_path() / fmt::format("total-{}.tmp", owner));
  } catch (const FileError&) {
    // The next run counts anew.
  }
}

}  // namespace terrazzo
