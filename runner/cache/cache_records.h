#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runner/cache/cache.h"
#include "runner/cache/cache_total.h"

/// The cache's small files: a magic word, a version, the content and a checksum.
namespace terrazzo {

/// Identifies a version of a file: while it is equal, the memoised digest is valid.
struct FileStamp {
  uint64_t bytes = 0;
  int64_t modified_ns = 0;
  int64_t changed_ns = 0;  ///< of the inode: moves even when a tool sets the modification time back
  uint64_t inode = 0;
  bool operator==(const FileStamp&) const = default;
};
struct FileMemo {
  FileStamp stamp;
  Digest content;
};

std::vector<uint8_t> stage_to_bytes(const Digest& key, const StageRecord& record);
/// Throws DamagedFile if the bytes are anything but the record of `key`.
StageRecord stage_from_bytes(const Digest& key, const std::vector<uint8_t>& bytes);

std::vector<uint8_t> memo_to_bytes(const Digest& path, const FileMemo& memo);
/// Throws DamagedFile if the bytes are anything but the memo of the file whose path has that digest.
FileMemo memo_from_bytes(const Digest& path, const std::vector<uint8_t>& bytes);

std::vector<uint8_t> total_to_bytes(const CacheTotal& total);
/// Throws DamagedFile if the bytes are anything but a total.
CacheTotal total_from_bytes(const std::vector<uint8_t>& bytes);

}  // namespace terrazzo
