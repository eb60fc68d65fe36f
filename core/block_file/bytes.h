#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/base/error.h"

namespace terrazzo {

/// The file is damaged, truncated, of another format or of a newer version.
class DamagedFile : public Error {
 public:
  using Error::Error;
};

/// The file was written by an older version.
class OutdatedFile : public DamagedFile {
 public:
  using DamagedFile::DamagedFile;
};

/// Serializes numbers (little endian), texts and digests.
class ByteWriter {
 public:
  template <typename T>
  void put(const T& value) {
    static_assert((std::is_trivially_copyable_v<T> && std::has_unique_object_representations_v<T>) ||
                  std::is_floating_point_v<T>);
    append(&value, sizeof value);
  }
  void put_text(std::string_view text) {
    put(static_cast<uint32_t>(text.size()));
    append(text.data(), text.size());
  }
  void append(const void* data, size_t size);
  const std::vector<uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<uint8_t> bytes_;
};

/// Deserializes them. Every function throws DamagedFile instead of reading past the end.
class ByteReader {
 public:
  ByteReader(const void* data, size_t size) : at_(static_cast<const uint8_t*>(data)), left_(size) {}
  explicit ByteReader(const std::vector<uint8_t>& bytes) : ByteReader(bytes.data(), bytes.size()) {}

  template <typename T>
  T get() {
    T value;
    std::memcpy(&value, take(sizeof(T)), sizeof(T));
    return value;
  }
  /// A number below `end`; throws DamagedFile otherwise.
  template <typename T>
  T get_below(T end) {
    const T value = get<T>();
    if (value >= end) throw DamagedFile("a field is out of its range");
    return value;
  }
  std::string get_text() {
    const auto size = get<uint32_t>();
    return std::string(reinterpret_cast<const char*>(take(size)), size);
  }
  const uint8_t* take(size_t size) {
    if (size > left_) throw DamagedFile("it ends too early");
    const uint8_t* here = at_;
    at_ += size;
    left_ -= size;
    return here;
  }
  size_t left() const { return left_; }
  void expect_end() const {
    if (left_ != 0) throw DamagedFile("it is longer than it says");
  }

 private:
  const uint8_t* at_;
  size_t left_;
};

}  // namespace terrazzo
