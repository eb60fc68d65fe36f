#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>

namespace terrazzo {

/// Room on disk for what does not fit in memory: one file in the system's folder for temporary files (TMPDIR), without
/// a name, so that nothing is left of it when the program ends however it ends. Thread-safe.
class ScratchFile {
 public:
  /// The one of this process; made when it is needed first.
  static ScratchFile& shared();

  ScratchFile() = default;
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile();

  /// Room for so many bytes, at least 1: where it begins. None if the disk has not as much, or cannot be written to.
  std::optional<uint64_t> take(uint64_t bytes);
  /// Gives it back; the file shrinks when its end is not in use.
  void give_back(uint64_t at, uint64_t bytes);
  /// Throw Error if the disk fails.
  void write(uint64_t at, const void* data, uint64_t bytes);
  void read(uint64_t at, void* data, uint64_t bytes) const;
  /// Of the file, at present.
  uint64_t size() const;

 private:
  bool open();
  std::optional<uint64_t> take_free(uint64_t bytes);

  mutable std::mutex mutex_;
  int file_ = -1;
  uint64_t end_ = 0;
  std::map<uint64_t, uint64_t> free_;  ///< bytes by where they begin, no two side by side
};

}  // namespace terrazzo
