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
  /// Little endian, of at most 8 bytes.
  uint64_t number(uint64_t at, int bytes) const {
    uint8_t raw[8] = {};
    read(at, raw, bytes);
    uint64_t v = 0;
    for (int i = 0; i < bytes; i++) v |= uint64_t{raw[i]} << 8 * i;
    return v;
  }
  uint64_t big_endian(uint64_t at, int bytes) const {
    uint8_t raw[8] = {};
    read(at, raw, bytes);
    uint64_t v = 0;
    for (int i = 0; i < bytes; i++) v = v << 8 | raw[i];
    return v;
  }
  std::string text(uint64_t at, size_t bytes) const {
    std::string out(at < size_ ? size_t(std::min<uint64_t>(bytes, size_ - at)) : 0, '\0');
    out.resize(file_.read_at(at, out.data(), out.size(), path_));
    return out;
  }

 private:
  void read(uint64_t at, uint8_t* out, int bytes) const {
    if (at <= size_ && uint64_t(bytes) <= size_ - at) file_.read_at(at, out, size_t(bytes), path_);
  }

  const std::filesystem::path& path_;
  File file_;
  uint64_t size_;
};

}  // namespace terrazzo
