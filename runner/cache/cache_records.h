#pragma once

#include <cstdint>
#include <vector>

#include "core/file/file_stamp.h"
#include "runner/cache/stage_record.h"

/// The cache's small files: a magic word, a version, the content and a checksum.
namespace terrazzo {

struct FileMemo {
  FileStamp stamp;
  Digest content;
};

/// The size of the cache, see runner/cache/cache_total.h.
struct CacheTotal {
  uint64_t bytes = 0;
  int64_t counted_ns = 0;  ///< when all entries were last scanned; since the epoch
};

std::vector<uint8_t> stage_to_bytes(const Digest& key, const StageRecord& record);
/// Throws DamagedFile if the bytes are not a record of `key`.
StageRecord stage_from_bytes(const Digest& key, const std::vector<uint8_t>& bytes);

std::vector<uint8_t> memo_to_bytes(const Digest& path, const FileMemo& memo);
/// Throws DamagedFile if the bytes are not a memo of the file with this path digest.
FileMemo memo_from_bytes(const Digest& path, const std::vector<uint8_t>& bytes);

std::vector<uint8_t> total_to_bytes(const CacheTotal& total);
/// Throws DamagedFile if the bytes are not a total.
CacheTotal total_from_bytes(const std::vector<uint8_t>& bytes);

}  // namespace terrazzo
