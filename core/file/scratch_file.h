#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>

namespace terrazzo {

/// Disk space for data that does not fit in memory: one unnamed file in the system's folder for temporary files
/// (TMPDIR), which vanishes however the program ends. Thread-safe.
class ScratchFile {
 public:
  /// The file of this process, created on first use.
  static ScratchFile& shared();

  ScratchFile() = default;
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile();

  /// Allocates `bytes` (at least 1) and returns their offset. Nullopt if the disk is full or not writable.
  std::optional<uint64_t> take(uint64_t bytes);
  /// Frees a region. The file shrinks if its end is unused.
  void give_back(uint64_t at, uint64_t bytes);
  /// Throws Error if the disk fails.
  void write(uint64_t at, const void* data, uint64_t bytes);
  void read(uint64_t at, void* data, uint64_t bytes) const;
  /// The current size of the file in bytes.
  uint64_t size() const;

 private:
  bool open();
  std::optional<uint64_t> take_free(uint64_t bytes);

  mutable std::mutex mutex_;
  int file_ = -1;
  uint64_t end_ = 0;
  std::map<uint64_t, uint64_t> free_;  ///< size by offset; adjacent regions are merged
};

}  // namespace terrazzo
