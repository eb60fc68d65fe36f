#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "core/base/hash.h"
#include "core/base/task.h"
#include "core/block_file/bytes.h"
#include "core/block_file/sample_codec.h"
#include "core/file/file_io.h"

/// The container format of serialized values. Little endian:
///   header  magic "TZVALUE\0", format version, value type, digest, seconds, place and checksum of the contents, and a
///           checksum of all that
///   blocks  one after the other, each compressed by itself with zstd if that makes it smaller
///   contents  a description (opaque here), the streams, and of every block its sizes, coding and XXH3 checksum
/// A stream is a run of bytes or of float samples, cut into blocks of a fixed number of elements. Every byte of the
/// file lies under a checksum. Own format since no library in use reads single blocks of any kind of value in
/// parallel and finds every altered byte.
namespace terrazzo {

struct BlockFileHeader {
  uint32_t type = 0;
  Digest digest;
  double seconds = 0;
};

enum class StreamKind : uint8_t { bytes, samples };
inline constexpr uint64_t bytes_per_block = uint64_t{1} << 20;
inline constexpr uint64_t samples_per_block = uint64_t{1} << 18;
inline uint64_t block_elements(StreamKind kind) {
  return kind == StreamKind::bytes ? bytes_per_block : samples_per_block;
}

/// A block's content before decoding.
struct RawBlock {
  SampleCoding coding = SampleCoding::u8_divided;  ///< for samples
  std::vector<uint8_t> bytes;
};

struct StoredBlock {
  uint64_t offset = 0;
  uint32_t raw_bytes = 0;
  uint32_t stored_bytes = 0;  ///< == raw_bytes: not compressed
  uint64_t checksum = 0;      ///< of the stored bytes
  SampleCoding coding = SampleCoding::u8_divided;
};

struct BlockStream {
  StreamKind kind = StreamKind::bytes;
  uint64_t elements = 0;
  std::vector<StoredBlock> blocks;
};

/// Writes a block file; blocks are encoded in parallel. Removes the file unless finish() is called. Throws Error. Not
/// thread-safe.
class BlockFileWriter {
 public:
  BlockFileWriter(std::filesystem::path path, const Task& task);
  ~BlockFileWriter();
  BlockFileWriter(const BlockFileWriter&) = delete;
  BlockFileWriter& operator=(const BlockFileWriter&) = delete;

  /// Begins a stream and returns its number.
  uint32_t begin_stream(StreamKind kind);
  /// Appends to the last begun stream. Every call except the last one of a stream must add a multiple of
  /// block_elements().
  void add_bytes(const uint8_t* bytes, uint64_t count);
  void add_samples(const float* samples, uint64_t count);
  /// With `sync`, waits until the file is on disk.
  void finish(const BlockFileHeader& header, const std::vector<uint8_t>& description, bool sync);

 private:
  void add_blocks(uint64_t count, const std::function<RawBlock(uint64_t at, uint64_t count)>& block);

  std::filesystem::path path_;
  const Task& task_;
  File file_;
  bool regular_ = true;
  bool finished_ = false;
  uint64_t end_;
  std::vector<BlockStream> streams_;
};

/// An open block file. Small files are loaded into memory and closed. Immutable; thread-safe.
class BlockFile {
 public:
  /// Opens and verifies every checksum. Throws DamagedFile, or Error if the file cannot be read.
  static std::shared_ptr<const BlockFile> open(const std::filesystem::path& path);
  /// Verifies only the header and the contents; blocks are verified when they are read. Throws as open.
  static std::shared_ptr<const BlockFile> open_contents(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  const BlockFileHeader& header() const { return header_; }
  const std::vector<uint8_t>& description() const { return description_; }
  const std::vector<BlockStream>& streams() const { return streams_; }

  /// Reads, verifies and decompresses one block. Throws DamagedFile or Error. Thread-safe.
  RawBlock read(const StoredBlock& block) const;

 private:
  BlockFile() = default;
  void read_bytes(uint64_t offset, void* out, size_t size) const;
  void read_contents(uint64_t offset, uint64_t size, uint64_t checksum);
  void verify_block(const StoredBlock& block, std::vector<uint8_t>& stored) const;

  std::filesystem::path path_;
  File file_;
  std::vector<uint8_t> memory_;  ///< the whole file, if it is small
  BlockFileHeader header_;
  std::vector<uint8_t> description_;
  std::vector<BlockStream> streams_;
};

/// Reads only the header. Throws DamagedFile or Error.
BlockFileHeader read_block_file_header(const std::filesystem::path& path);

}  // namespace terrazzo
