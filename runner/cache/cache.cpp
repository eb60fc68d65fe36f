#include "runner/cache/cache.h"

#include <cerrno>

#include <fmt/format.h>

#include "core/block_file/bytes.h"
#include "core/file/atomic_file.h"
#include "core/file/file_io.h"
#include "core/file/user_folders.h"
#include "core/image/pixel_maker.h"
#include "core/node/serialize.h"
#include "runner/cache/cache_records.h"
#include "runner/cache/cache_state.h"

namespace terrazzo {

namespace {

/// Faster results are not synced and may be lost in a power failure: syncing thousands of small entries would take
/// longer than recomputing them. A partly written entry fails its checksum.
constexpr double seconds_worth_syncing = 0.05;

}  // namespace

std::filesystem::path Cache::default_folder() {
  return user_folder("TERRAZZO_CACHE", "XDG_CACHE_HOME", ".cache");
}

Cache::Cache(const std::filesystem::path& folder, uint64_t limit)
    : state_(std::make_unique<CacheState>(std::filesystem::absolute(folder), limit)) {}
Cache::~Cache() = default;

const std::filesystem::path& Cache::folder() const {
  return state_->given_folder;
}

uint64_t Cache::limit() const {
  return state_->limit.bytes;
}

std::vector<std::string> Cache::take_warnings() {
  return state_->take_warnings();
}

std::optional<StageRecord> Cache::find_stage(const Digest& key) {
  const std::filesystem::path path = state_->folder.path_of(EntryKind::stage, key);
  try {
    const auto bytes = CacheFolder::read_and_use(path);
    if (bytes) return stage_from_bytes(key, *bytes);
  } catch (const DamagedFile& e) {
    state_->discard(path, Error(fmt::format("{}: {}", path.string(), e.what())));
  } catch (const Error& e) {
    state_->warn(e.what());
  }
  return std::nullopt;
}

void Cache::store_stage(const Digest& key, const StageRecord& record) {
  try {
    state_->folder.write(state_->folder.path_of(EntryKind::stage, key), stage_to_bytes(key, record),
                         state_->pins.owner(), record.seconds >= seconds_worth_syncing);
  } catch (const Error& e) {
    state_->warn_unwritten(e);
  }
}

LeaseAttempt Cache::try_lease(const Digest& key) {
  return state_->leases.try_lease(key);
}

bool Cache::is_leased(const Digest& key) const {
  return state_->leases.is_taken(key);
}

bool Cache::has_value(const Digest& value) {
  state_->pins.pin(value);
  return CacheFolder::use(state_->folder.path_of(EntryKind::value, value));
}

std::optional<Value> Cache::load_value(const Digest& value) {
  const std::filesystem::path path = state_->folder.path_of(EntryKind::value, value);
  if (!has_value(value)) return std::nullopt;
  try {
    Value loaded = terrazzo::load_value(path);
    if (digest_of(loaded) != value)
      throw DamagedFile(fmt::format("{} is stored under another value's name", path.string()));
    return loaded;
  } catch (const DamagedFile& e) {
    state_->discard(path, e);
  } catch (const FileError& e) {
    if (e.code() != ENOENT) state_->warn(e.what());
  } catch (const Error& e) {
    state_->warn(e.what());
  }
  return std::nullopt;
}

uint64_t Cache::stored_bytes(const Digest& value) const {
  std::error_code missing;
  const uint64_t bytes = std::filesystem::file_size(state_->folder.path_of(EntryKind::value, value), missing);
  return missing ? 0 : bytes;
}

void Cache::store_value(const Value& value, double seconds, const Task& task) {
  if (load_value(digest_of(value))) return;  // which discards damaged entries
  const std::filesystem::path target = state_->folder.path_of(EntryKind::value, digest_of(value));
  try {
    const std::filesystem::path temporary = state_->folder.temporary(target, state_->pins.owner());
    const bool sync = seconds >= seconds_worth_syncing;
    save_value(value, temporary, task, seconds, sync);
    publish_file(temporary, target, sync);
    state_->folder.note_written(stored_bytes(digest_of(value)));
  } catch (const PixelError& e) {
    // Not an error of the cache: the reader of the pixels reports it.
    state_->warn(fmt::format("a result is not kept, as its pixels cannot be made: {}", e.what()));
  } catch (const Error& e) {
    state_->warn_unwritten(e);
  }
}

}  // namespace terrazzo
