#include <cerrno>

#include <fmt/format.h>
#include <unistd.h>

#include "core/node/serialize.h"
#include "runner/cache/cache.h"
#include "runner/cache/cache_records.h"
#include "runner/cache/cache_state.h"
#include "runner/cache/history_files.h"

namespace terrazzo {

namespace {

void check_small(const CacheEntry& entry, const std::vector<uint8_t>& bytes) {
  switch (entry.kind) {
    case EntryKind::stage:
      stage_from_bytes(entry.name, bytes);
      return;
    case EntryKind::file:
      memo_from_bytes(entry.name, bytes);
      return;
    case EntryKind::history:
      unsealed_history({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
      return;
    case EntryKind::value:
      return;
  }
}

/// Reads an entry from its first to its last byte. Throws DamagedFile, or Error if it cannot be read.
void read_all(const CacheEntry& entry) {
  if (entry.kind == EntryKind::value) {
    if (digest_of(load_value(entry.path)) != entry.name)
      throw DamagedFile(fmt::format("{} is stored under another value's name", entry.path.string()));
    return;
  }
  const auto bytes = CacheFolder::read(entry.path);
  if (!bytes) return;
  try {
    check_small(entry, *bytes);
  } catch (const DamagedFile& e) {
    throw DamagedFile(fmt::format("{} cannot be used: {}", entry.path.string(), e.what()));
  }
}

}  // namespace

CacheVerdict Cache::verify(const Task& task) {
  const CacheScan scan = state_->folder.scan();
  CacheVerdict verdict;
  const uint64_t total = scan.bytes();
  uint64_t done = 0;
  for (const CacheEntry& e : scan.entries) {
    task.progress(double(done) / double(total));
    done += e.bytes;
    try {
      read_all(e);
    } catch (const DamagedFile& trouble) {
      const bool is_gone = ::unlink(e.path.c_str()) == 0 || errno == ENOENT;
      const std::string why = is_gone ? "" : fmt::format("; it cannot be removed: {}", system_message(errno));
      verdict.damaged.push_back(trouble.what() + why);
      verdict.left += !is_gone;
    } catch (const FileError& trouble) {
      if (trouble.code() != ENOENT) state_->warn(trouble.what());
    } catch (const Error& trouble) {
      state_->warn(trouble.what());
    }
  }
  return verdict;
}

}  // namespace terrazzo
