#include "core/integrity/file_integrity.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <span>
#include <vector>

#include <zlib.h>

#include "core/file/file_io.h"
#include "core/integrity/packed_lengths.h"
#include "core/integrity/picture_ends.h"

namespace terrazzo {

namespace {

constexpr uint8_t start_of_image = 0xd8, end_of_image = 0xd9, app1 = 0xe1;

bool is_frame_header(uint8_t marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

bool stands_alone(uint8_t marker) {
  return marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8);
}

/// Reads numbers from a file; past its end all bytes are 0.
class Numbers {
 public:
  explicit Numbers(const std::filesystem::path& path) : in_(path, std::ios::binary | std::ios::ate) {
    if (!in_.is_open()) throw_system_error("read", path, errno);
    size_ = uint64_t(std::max<std::streamoff>(0, in_.tellg()));
  }
  void set_big_endian(bool is_big_endian) { is_big_endian_ = is_big_endian; }
  uint64_t size() const { return size_; }
  uint64_t number(uint64_t at, int bytes) {
    uint8_t raw[8] = {};
    in_.clear();
    if (at + uint64_t(bytes) <= size_) {
      in_.seekg(std::streamoff(at));
      in_.read(reinterpret_cast<char*>(raw), bytes);
    }
    uint64_t v = 0;
    for (int i = 0; i < bytes; i++) v |= uint64_t{raw[i]} << 8 * (is_big_endian_ ? bytes - 1 - i : i);
    return v;
  }

 private:
  std::ifstream in_;
  uint64_t size_ = 0;
  bool is_big_endian_ = true;
};

/// The bytes of a file, buffered in part; past the end they are 0.
class Window {
 public:
  explicit Window(const std::filesystem::path& path)
      : path_(path), file_(open_to_read(path)), size_(file_.size(path)) {}
  uint64_t size() const { return size_; }
  uint8_t byte(uint64_t at) {
    if (at < begin_ || at >= begin_ + part_.size()) {
      begin_ = at;
      part_.resize(most_);
      part_.resize(file_.read_at(at, part_.data(), most_, path_));
    }
    return part_.empty() ? uint8_t{0} : part_[size_t(at - begin_)];
  }

 private:
  static constexpr size_t most_ = size_t{1} << 16;
  const std::filesystem::path& path_;
  File file_;
  uint64_t size_;
  uint64_t begin_ = 0;
  std::vector<uint8_t> part_;
};

constexpr uint64_t png_signature = 0x89504e470d0a1a0a;

/// "II" or "MM" and 42, or 43 for BigTIFF, in the byte order that the letters name.
bool is_tiff(uint64_t start) {
  return start == 0x49492a00 || start == 0x49492b00 || start == 0x4d4d002a || start == 0x4d4d002b;
}

constexpr uint64_t lzw = 5, deflate = 8, packbits = 32773, old_deflate = 32946;  // compressions

int bytes_of_type(uint64_t type) {
  constexpr uint64_t tiff_short = 3, tiff_long8 = 16, tiff_ifd8 = 18;
  return type == tiff_short ? 2 : type == tiff_long8 || type == tiff_ifd8 ? 8 : 4;
}

/// The numbers of one directory entry, which begins with its tag at `entry`.
std::vector<uint64_t> entry_numbers(Numbers& file, uint64_t entry, bool is_big_tiff) {
  const int bytes = bytes_of_type(file.number(entry + 2, 2));
  const int word = is_big_tiff ? 8 : 4;
  const uint64_t count = file.number(entry + 4, word);
  uint64_t at = entry + 4 + word;
  if (count > file.size() / bytes) return {UINT64_MAX / 2};  // more than the file can hold
  if (count * bytes > uint64_t(word)) at = file.number(at, word);
  std::vector<uint64_t> out(count);
  for (uint64_t i = 0; i < count; i++) out[i] = file.number(at + i * bytes, bytes);
  return out;
}

}  // namespace

JpegFacts read_jpeg_facts(const std::filesystem::path& path, bool to_its_end) {
  JpegFacts facts;
  Window file(path);
  if (file.byte(0) != 0xff || file.byte(1) != start_of_image) return facts;
  const auto word = [&](uint64_t i) { return file.byte(i) << 8 | file.byte(i + 1); };
  uint64_t i = 0;
  while (i + 1 < file.size()) {
    // Between segments is entropy-coded data, in which 0xff is followed by 0.
    if (file.byte(i) != 0xff || file.byte(i + 1) == 0 || file.byte(i + 1) == 0xff) {
      i++;
      continue;
    }
    const uint8_t marker = file.byte(i + 1);
    i += 2;
    if (marker == end_of_image) {
      facts.complete = true;
      break;
    }
    if (stands_alone(marker)) continue;
    if (i + 1 >= file.size()) break;
    if (is_frame_header(marker) && i + 7 < file.size()) {
      constexpr uint8_t progressive_frames[] = {0xc2, 0xc6, 0xca, 0xce};
      facts.progressive = std::ranges::find(progressive_frames, marker) != std::end(progressive_frames);
      facts.bits = file.byte(i + 2);
      facts.size = {word(i + 5), word(i + 3)};
      facts.components = file.byte(i + 7);
      if (!to_its_end) break;
    }
    facts.has_exif |= marker == app1;
    i += uint64_t(word(i));
  }
  return facts;
}

bool png_is_complete(const std::filesystem::path& path) {
  constexpr uint64_t end_mark = 0x49454e44, around = 12;  // "IEND"; a chunk's length, name and checksum
  Numbers file(path);
  if (file.size() >= around && file.number(file.size() - around, 8) == end_mark) return true;
  for (uint64_t at = 8; at + around <= file.size();) {
    const uint64_t next = at + around + file.number(at, 4);
    if (file.number(at + 4, 4) == end_mark) return next <= file.size();
    at = next;
  }
  return false;
}

namespace {

/// An image's strips or tiles, from its directory.
struct TiffPieces {
  std::vector<uint64_t> offsets, byte_counts;
  uint64_t compression = 1;
  uint64_t width = 0, height = 0;  ///< of the image
  uint64_t piece_width = 0;        ///< of tiles; 0 if there are strips
  uint64_t piece_height = UINT32_MAX;
  uint64_t bits = 1, samples = 1;  ///< bits of each sample
  bool by_planes = false;          ///< a piece holds one sample of each pixel
  bool subsampled = false;         ///< it may hold fewer samples than pixels
  bool low_bits_first = false;
  uint64_t photometric = 0, format = 1;
  std::vector<uint64_t> extra_samples;
};

/// Stores one entry of a directory.
void note_entry(TiffPieces& pieces, uint64_t tag, const std::vector<uint64_t>& numbers) {
  constexpr uint64_t tag_width = 256, tag_height = 257, tag_bits = 258, tag_compression = 259, tag_photometric = 262,
                     tag_fill_order = 266, tag_strip_offsets = 273, tag_samples = 277, tag_strip_height = 278,
                     tag_strip_bytes = 279, tag_planes = 284, tag_tile_width = 322, tag_tile_height = 323,
                     tag_tile_offsets = 324, tag_tile_bytes = 325, tag_extra_samples = 338, tag_format = 339;
  constexpr uint64_t ycbcr = 6, one_plane_each = 2, low_first = 2;
  if (numbers.empty()) return;
  const uint64_t first = numbers.front();
  switch (tag) {
    case tag_width:
      pieces.width = first;
      break;
    case tag_height:
      pieces.height = first;
      break;
    case tag_bits:
      pieces.bits = first;
      break;
    case tag_compression:
      pieces.compression = first;
      break;
    case tag_photometric:
      pieces.photometric = first;
      pieces.subsampled = first == ycbcr;
      break;
    case tag_fill_order:
      pieces.low_bits_first = first == low_first;
      break;
    case tag_samples:
      pieces.samples = first;
      break;
    case tag_planes:
      pieces.by_planes = first == one_plane_each;
      break;
    case tag_tile_width:
      pieces.piece_width = first;
      break;
    case tag_strip_height:
    case tag_tile_height:
      pieces.piece_height = first;
      break;
    case tag_extra_samples:
      pieces.extra_samples = numbers;
      break;
    case tag_format:
      pieces.format = first;
      break;
    case tag_strip_offsets:
    case tag_tile_offsets:
      pieces.offsets = numbers;
      break;
    case tag_strip_bytes:
    case tag_tile_bytes:
      pieces.byte_counts = numbers;
      break;
    default:
      break;
  }
}

/// The pieces of the first image.
TiffPieces tiff_pieces(Numbers& file) {
  constexpr uint64_t tag_last_of_use = 339;
  TiffPieces out;
  file.set_big_endian(file.number(0, 1) == 'M');
  const bool is_big_tiff = file.number(2, 2) == 43;
  const uint64_t directory = is_big_tiff ? file.number(8, 8) : file.number(4, 4);
  const uint64_t entries = file.number(directory, is_big_tiff ? 8 : 2);
  const uint64_t first = directory + (is_big_tiff ? 8 : 2), entry_size = is_big_tiff ? 20 : 12;
  if (entries > file.size() / entry_size || first + entries * entry_size > file.size()) return out;
  for (uint64_t i = 0; i < entries; i++) {
    const uint64_t entry = first + i * entry_size, tag = file.number(entry, 2);
    if (tag <= tag_last_of_use) note_entry(out, tag, entry_numbers(file, entry, is_big_tiff));
  }
  return out;
}

/// Whether these bytes of a file are one complete zlib stream with a correct checksum.
bool is_sound_stream(const File& file, const std::filesystem::path& path, uint64_t at, uint64_t count) {
  constexpr size_t most_at_once = size_t{1} << 18;
  std::vector<uint8_t> packed(size_t(std::min<uint64_t>(count, most_at_once))), unpacked(size_t{1} << 16);
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return true;
  int result = Z_OK;
  while (result == Z_OK) {
    if (stream.avail_in == 0 && count > 0) {
      const size_t got = file.read_at(at, packed.data(), size_t(std::min<uint64_t>(count, packed.size())), path);
      at += got;
      count = got > 0 ? count - got : 0;
      stream.next_in = packed.data();
      stream.avail_in = uInt(got);
    }
    stream.next_out = unpacked.data();
    stream.avail_out = uInt(unpacked.size());
    result = inflate(&stream, Z_NO_FLUSH);
  }
  inflateEnd(&stream);
  return result == Z_STREAM_END;
}

}  // namespace

TiffFacts read_tiff_facts(const std::filesystem::path& path) {
  Numbers file(path);
  if (!is_tiff(file.number(0, 4))) return {};
  const TiffPieces pieces = tiff_pieces(file);
  TiffFacts facts{int(pieces.samples), int(pieces.bits), int(pieces.format), int(pieces.photometric), {}};
  for (const uint64_t e : pieces.extra_samples) facts.extra_samples.push_back(int(e));
  return facts;
}

bool tiff_is_complete(const std::filesystem::path& path) {
  Numbers file(path);
  const TiffPieces pieces = tiff_pieces(file);
  if (pieces.offsets.empty()) return false;
  for (size_t i = 0; i < pieces.offsets.size(); i++)
    if (pieces.offsets[i] > file.size() ||
        (i < pieces.byte_counts.size() && pieces.byte_counts[i] > file.size() - pieces.offsets[i]))
      return false;
  return true;
}

namespace {

/// Whether a piece of LZW or PackBits expands to exactly as many bytes as it should.
bool has_its_length(const TiffPieces& pieces, size_t index, std::span<const uint8_t> packed) {
  const bool is_tile = pieces.piece_width > 0;
  const uint64_t samples = pieces.by_planes ? 1 : pieces.samples;
  const uint64_t row = ((is_tile ? pieces.piece_width : pieces.width) * pieces.bits * samples + 7) / 8;
  const uint64_t rows = is_tile ? pieces.piece_height : std::min(pieces.piece_height, pieces.height);
  const auto length = pieces.compression == lzw ? lzw_length(packed) : packbits_length(packed);
  if (length == row * rows) return true;
  if (is_tile || rows == 0) return false;
  // The last strip may also be cut to the image.
  const uint64_t strips = (pieces.height + rows - 1) / rows;
  return length == row * (pieces.height - (strips - 1) * rows) && index % strips == strips - 1;
}

bool is_sound_piece(const File& file, const std::filesystem::path& path, const TiffPieces& pieces, size_t index) {
  const uint64_t at = pieces.offsets[index], count = pieces.byte_counts[index];
  if (pieces.compression == deflate || pieces.compression == old_deflate) return is_sound_stream(file, path, at, count);
  std::vector<uint8_t> packed(count);
  packed.resize(file.read_at(at, packed.data(), packed.size(), path));
  // What libtiff calls old-style LZW: other bit order.
  const bool is_old_lzw = pieces.compression == lzw && packed.size() > 1 && packed[0] == 0 && (packed[1] & 1) != 0;
  return is_old_lzw || has_its_length(pieces, index, packed);
}

}  // namespace

bool tiff_is_sound(const std::filesystem::path& path) {
  Numbers numbers(path);
  const TiffPieces pieces = tiff_pieces(numbers);
  const bool has_checksums = pieces.compression == deflate || pieces.compression == old_deflate;
  const bool has_lengths =
      (pieces.compression == lzw || pieces.compression == packbits) && !pieces.subsampled && !pieces.low_bits_first;
  if (!has_checksums && !has_lengths) return true;
  const File file = open_to_read(path);
  for (size_t i = 0; i < std::min(pieces.offsets.size(), pieces.byte_counts.size()); i++) {
    if (pieces.byte_counts[i] == 0) continue;  // pieces that were never written read as 0
    if (pieces.byte_counts[i] > numbers.size() || !is_sound_piece(file, path, pieces, i)) return false;
  }
  return true;
}

bool seems_complete(const std::filesystem::path& path) {
  Numbers file(path);
  if (file.number(0, 8) == png_signature) return png_is_complete(path);
  if (file.number(0, 2) == (0xff00 | start_of_image))
    return file.number(file.size() - 2, 2) == (0xff00 | end_of_image) || read_jpeg_facts(path).complete;
  return is_tiff(file.number(0, 4)) ? tiff_is_complete(path) : is_untruncated(path);
}

}  // namespace terrazzo
