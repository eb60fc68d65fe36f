#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>

#include "core/file/file_io.h"

namespace terrazzo {

/// Reads numbers and texts at offsets of a file. Past its end numbers are 0 and texts are shorter.
class FileNumbers {
 public:
  /// `path` must outlive it. Throws FileError if the file cannot be opened.
  explicit FileNumbers(const std::filesystem::path& path)
      : path_(path), file_(open_to_read(path)), size_(file_.size(path)) {}
  uint64_t size() const { return size_; }
  uint8_t byte(uint64_t at) const {
    if (at - begin_ >= part_.size()) load(at);
    return at - begin_ < part_.size() ? uint8_t(part_[at - begin_]) : uint8_t{0};
  }
  /// Little endian, of at most 8 bytes.
  uint64_t number(uint64_t at, int bytes) const {
    uint64_t v = 0;
    for (int i = bytes - 1; i >= 0 && holds(at, bytes); i--) v = v << 8 | byte(at + uint64_t(i));
    return v;
  }
  uint64_t big_endian(uint64_t at, int bytes) const {
    uint64_t v = 0;
    for (int i = 0; i < bytes && holds(at, bytes); i++) v = v << 8 | byte(at + uint64_t(i));
    return v;
  }
  std::string text(uint64_t at, size_t bytes) const {
    std::string out(at < size_ ? size_t(std::min<uint64_t>(bytes, size_ - at)) : 0, '\0');
    out.resize(file_.read_at(at, out.data(), out.size(), path_));
    return out;
  }

 private:
  bool holds(uint64_t at, int bytes) const { return at <= size_ && uint64_t(bytes) <= size_ - at; }
  void load(uint64_t at) const {
    constexpr size_t at_once = size_t{1} << 14;
    begin_ = at;
    part_ = text(at, at_once);
  }

  const std::filesystem::path& path_;
  File file_;
  uint64_t size_;
  mutable uint64_t begin_ = 0;
  mutable std::string part_;  ///< of the file, from `begin_`
};

}  // namespace terrazzo
