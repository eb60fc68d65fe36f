#include "runner/cache/cache_state.h"

#include <cerrno>

#include <fmt/format.h>
#include <unistd.h>

#include "core/block_file/bytes.h"
#include "core/file/file_io.h"

namespace terrazzo {

CacheState::CacheState(std::filesystem::path given, uint64_t bytes)
    : given_folder(std::move(given)),
      limit(bytes == 0 ? cache_limit(given_folder) : CacheLimit{bytes, ""}),
      folder(given_folder),
      pins(folder.pins(), folder.lock()),
      leases(folder.leases()) {
  if (pins.failure() != 0) warn_unwritten(FileError("", pins.failure()));
}

void CacheState::warn(const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (said_.insert(text).second) warnings_.push_back(text);
}

void CacheState::warn_unwritten(const Error& why) {
  const auto* system = dynamic_cast<const FileError*>(&why);
  warn(fmt::format("the cache {} cannot be written, so results are not kept: {}", given_folder.string(),
                   system ? system_message(system->code()) : why.what()));
}

void CacheState::discard(const std::filesystem::path& path, const Error& why) {
  const bool is_gone = ::unlink(path.c_str()) == 0 || errno == ENOENT;
  if (dynamic_cast<const OutdatedFile*>(&why)) return;  // normal after a change of the format
  warn(fmt::format("a damaged cache entry {}: {}", is_gone ? "was removed" : "is not used, and cannot be removed",
                   why.what()));
}

std::vector<std::string> CacheState::take_warnings() {
  const std::lock_guard lock(mutex_);
  return std::exchange(warnings_, {});
}

}  // namespace terrazzo
