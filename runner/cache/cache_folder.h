#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/hash.h"
#include "core/file/file_io.h"
#include "core/file/file_stamp.h"

/// The cache's layout on disk:
///   v1/values/ab/<digest>.tzv   core/node/serialize.h
///   v1/stages/ab/<key>          runner/cache/cache_records.h
///   v1/files/ab/<path digest>   runner/cache/cache_records.h
///   v1/pins/, v1/lock           runner/cache/cache_pins.h
///   v1/leases/<key>/            runner/cache/cache_leases.h
///   v1/total                    runner/cache/cache_total.h
///   history/<path digest>.txt   runner/cache/history_files.h
///   settings.txt                runner/cache/cache_limit.h
/// An entry's modification time is the time of its last use. Files being written end in ".tmp".
namespace terrazzo {

enum class EntryKind : uint8_t { value, stage, file, history };

struct CacheEntry {
  EntryKind kind = EntryKind::value;
  Digest name;
  std::filesystem::path path;
  uint64_t bytes = 0;
  int64_t used_ns = 0;  ///< since the epoch
};

struct TemporaryEntry {
  std::filesystem::path path;
  std::string owner;
  uint64_t bytes = 0;
};

struct CacheScan {
  std::vector<CacheEntry> entries;  ///< ordered by kind, then by name
  std::vector<TemporaryEntry> temporaries;
  uint64_t bytes() const;
};

/// Thread-safe.
class CacheFolder {
 public:
  /// Creates the folders. Throws Error if that fails.
  explicit CacheFolder(const std::filesystem::path& folder);

  const std::filesystem::path& root() const { return root_; }
  std::filesystem::path path_of(EntryKind kind, const Digest& name) const;
  std::filesystem::path pins() const { return root_ / "pins"; }
  std::filesystem::path leases() const { return root_ / "leases"; }
  std::filesystem::path lock() const { return root_ / "lock"; }
  std::filesystem::path total() const { return root_ / "total"; }
  std::filesystem::path history() const { return root_.parent_path() / "history"; }

  /// Whether the folder contains a cache. Changes nothing.
  static bool is_in(const std::filesystem::path& folder);

  /// A temporary name beside `target`, whose folder is created. `owner`: see Pins::owner. Throws FileError.
  std::filesystem::path temporary(const std::filesystem::path& target, const std::string& owner);
  /// Writes atomically; durably, if `sync`. Throws FileError.
  void write(const std::filesystem::path& target, const std::vector<uint8_t>& bytes, const std::string& owner,
             bool sync);

  /// The bytes of a small file; nullopt if it does not exist. Throws FileError.
  static std::optional<std::vector<uint8_t>> read(const std::filesystem::path& path);
  /// The same, and marks the entry as used now.
  static std::optional<std::vector<uint8_t>> read_and_use(const std::filesystem::path& path);
  /// Adds an entry that was not written by `write` to the total.
  void note_written(uint64_t bytes) { written_ += bytes; }
  /// The bytes written since the last call.
  uint64_t take_written() { return written_.exchange(0); }
  /// Marks an entry as used now; false if it does not exist.
  static bool use(const std::filesystem::path& path);

  /// All entries and temporary files.
  CacheScan scan() const;

 private:
  std::filesystem::path root_;
  std::atomic<uint64_t> temporaries_{0}, written_{0};
};

}  // namespace terrazzo
