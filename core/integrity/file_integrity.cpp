#include "core/integrity/file_integrity.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include <zlib.h>

#include "core/integrity/file_numbers.h"
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

constexpr uint64_t png_signature = 0x89504e470d0a1a0a;

/// "II" or "MM" and 42, or 43 for BigTIFF, in the byte order that the letters name.
bool is_tiff(uint64_t start) {
  return start == 0x49492a00 || start == 0x49492b00 || start == 0x4d4d002a || start == 0x4d4d002b;
}

/// Of a directory's entries.
enum Tag : uint64_t {
  tag_width = 256,
  tag_height = 257,
  tag_bits_of_sample = 258,
  tag_compression = 259,
  tag_photometric = 262,
  tag_fill_order = 266,
  tag_strip_offsets = 273,
  tag_samples_of_pixel = 277,
  tag_strip_height = 278,
  tag_strip_bytes = 279,
  tag_planes = 284,
  tag_tile_width = 322,
  tag_tile_height = 323,
  tag_tile_offsets = 324,
  tag_tile_bytes = 325,
  tag_extra_samples = 338,
  tag_sample_format = 339
};

/// The directory of a TIFF file's first image.
class TiffDirectory {
 public:
  explicit TiffDirectory(const std::filesystem::path& path)
      : file_(path), is_big_endian_(file_.byte(0) == 'M'), is_big_tiff_(number_at(2, 2) == 43) {
    const int word = is_big_tiff_ ? 8 : 4;
    const uint64_t at = number_at(is_big_tiff_ ? 8 : 4, word), head = is_big_tiff_ ? 8 : 2;
    first_ = at + head;
    entries_ = number_at(at, int(head));
    if (entries_ > file_.size() / entry_size() || first_ + entries_ * entry_size() > file_.size()) entries_ = 0;
  }
  uint64_t file_size() const { return file_.size(); }
  /// Those of an entry; empty if there is none.
  std::vector<uint64_t> numbers(Tag tag) const {
    for (uint64_t i = entries_; i-- > 0;)
      if (const uint64_t entry = first_ + i * entry_size(); number_at(entry, 2) == tag) return numbers_of(entry);
    return {};
  }
  uint64_t number(Tag tag, uint64_t otherwise) const {
    const std::vector<uint64_t> all = numbers(tag);
    return all.empty() ? otherwise : all.front();
  }
  /// Of strips or tiles, whichever there are.
  std::vector<uint64_t> offsets() const {
    return numbers(has(tag_tile_offsets) ? tag_tile_offsets : tag_strip_offsets);
  }
  std::vector<uint64_t> byte_counts() const { return numbers(has(tag_tile_bytes) ? tag_tile_bytes : tag_strip_bytes); }

 private:
  bool has(Tag tag) const { return !numbers(tag).empty(); }
  uint64_t entry_size() const { return is_big_tiff_ ? 20 : 12; }
  uint64_t number_at(uint64_t at, int bytes) const {
    return is_big_endian_ ? file_.big_endian(at, bytes) : file_.number(at, bytes);
  }
  std::vector<uint64_t> numbers_of(uint64_t entry) const {
    constexpr uint64_t tiff_short = 3, tiff_long8 = 16, tiff_ifd8 = 18;
    const uint64_t type = number_at(entry + 2, 2);
    const int bytes = type == tiff_short ? 2 : type == tiff_long8 || type == tiff_ifd8 ? 8 : 4;
    const int word = is_big_tiff_ ? 8 : 4;
    const uint64_t count = number_at(entry + 4, word);
    uint64_t at = entry + 4 + uint64_t(word);
    if (count > file_.size() / uint64_t(bytes)) return {UINT64_MAX / 2};  // more than the file can hold
    if (count * uint64_t(bytes) > uint64_t(word)) at = number_at(at, word);
    std::vector<uint64_t> out(count);
    for (uint64_t i = 0; i < count; i++) out[i] = number_at(at + i * uint64_t(bytes), bytes);
    return out;
  }

  FileNumbers file_;
  bool is_big_endian_, is_big_tiff_;
  uint64_t first_ = 0, entries_ = 0;
};

}  // namespace

JpegFacts read_jpeg_facts(const std::filesystem::path& path, bool to_its_end) {
  JpegFacts facts;
  const FileNumbers file(path);
  if (file.byte(0) != 0xff || file.byte(1) != start_of_image) return facts;
  const auto word = [&](uint64_t i) { return int(file.byte(i) << 8 | file.byte(i + 1)); };
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

namespace {

/// Whether the chunks of a PNG file continue to the IEND chunk.
bool png_is_complete(const std::filesystem::path& path) {
  constexpr uint64_t end_mark = 0x49454e44, around = 12;  // "IEND"; a chunk's length, name and checksum
  const FileNumbers file(path);
  if (file.size() >= around && file.big_endian(file.size() - around, 8) == end_mark) return true;
  for (uint64_t at = 8; at + around <= file.size();) {
    const uint64_t next = at + around + file.big_endian(at, 4);
    if (file.big_endian(at + 4, 4) == end_mark) return next <= file.size();
    at = next;
  }
  return false;
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
  if (!is_tiff(FileNumbers(path).big_endian(0, 4))) return {};
  const TiffDirectory tiff(path);
  TiffFacts facts{int(tiff.number(tag_samples_of_pixel, 1)),
                  int(tiff.number(tag_bits_of_sample, 1)),
                  int(tiff.number(tag_sample_format, 1)),
                  int(tiff.number(tag_photometric, 0)),
                  {}};
  for (const uint64_t e : tiff.numbers(tag_extra_samples)) facts.extra_samples.push_back(int(e));
  return facts;
}

bool tiff_is_complete(const std::filesystem::path& path) {
  const TiffDirectory tiff(path);
  const std::vector<uint64_t> offsets = tiff.offsets(), byte_counts = tiff.byte_counts();
  for (size_t i = 0; i < offsets.size(); i++)
    if (offsets[i] > tiff.file_size() || (i < byte_counts.size() && byte_counts[i] > tiff.file_size() - offsets[i]))
      return false;
  return !offsets.empty();
}

namespace {

/// The unpacked lengths of strips or tiles.
struct PieceLengths {
  explicit PieceLengths(const TiffDirectory& tiff) {
    constexpr uint64_t one_plane_each = 2;
    is_tile = tiff.number(tag_tile_width, 0) > 0;
    const uint64_t columns = tiff.number(is_tile ? tag_tile_width : tag_width, 0), height = tiff.number(tag_height, 0);
    const uint64_t samples = tiff.number(tag_planes, 1) == one_plane_each ? 1 : tiff.number(tag_samples_of_pixel, 1);
    row = (columns * tiff.number(tag_bits_of_sample, 1) * samples + 7) / 8;
    rows = tiff.number(is_tile ? tag_tile_height : tag_strip_height, UINT32_MAX);
    if (is_tile) return;
    rows = std::min(rows, height);
    strips = rows > 0 ? (height + rows - 1) / rows : 0;
    rows_of_last = strips > 0 ? height - (strips - 1) * rows : 0;
  }
  bool fits(size_t index, uint64_t length) const {
    if (length == row * rows) return true;
    // The last strip may also be cut to the image.
    return strips > 0 && length == row * rows_of_last && index % strips == strips - 1;
  }
  bool is_tile;
  uint64_t row, rows, strips = 0, rows_of_last = 0;
};

}  // namespace

bool tiff_is_sound(const std::filesystem::path& path) {
  constexpr uint64_t lzw = 5, deflate = 8, packbits = 32773, old_deflate = 32946;  // compressions
  constexpr uint64_t ycbcr = 6, low_bits_first = 2;
  const TiffDirectory tiff(path);
  const uint64_t packing = tiff.number(tag_compression, 1);
  const bool has_checksums = packing == deflate || packing == old_deflate;
  // Where colours are subsampled there are fewer samples than pixels.
  const bool has_lengths = (packing == lzw || packing == packbits) && tiff.number(tag_photometric, 0) != ycbcr &&
                           tiff.number(tag_fill_order, 1) != low_bits_first;
  if (!has_checksums && !has_lengths) return true;
  const PieceLengths lengths(tiff);
  const File file = open_to_read(path);
  const std::vector<uint64_t> offsets = tiff.offsets(), byte_counts = tiff.byte_counts();
  for (size_t i = 0; i < std::min(offsets.size(), byte_counts.size()); i++) {
    const uint64_t count = byte_counts[i];
    if (count == 0) continue;  // pieces that were never written read as 0
    if (count > tiff.file_size()) return false;
    if (has_checksums) {
      if (!is_sound_stream(file, path, offsets[i], count)) return false;
      continue;
    }
    std::vector<uint8_t> packed(count);
    packed.resize(file.read_at(offsets[i], packed.data(), packed.size(), path));
    // What libtiff calls old-style LZW: other bit order.
    if (packing == lzw && packed.size() > 1 && packed[0] == 0 && (packed[1] & 1) != 0) continue;
    const std::optional<uint64_t> length = packing == lzw ? lzw_length(packed) : packbits_length(packed);
    if (!length || !lengths.fits(i, *length)) return false;
  }
  return true;
}

bool seems_complete(const std::filesystem::path& path) {
  const FileNumbers file(path);
  if (file.big_endian(0, 8) == png_signature) return png_is_complete(path);
  if (file.big_endian(0, 2) == (0xff00 | start_of_image))
    return file.big_endian(file.size() - 2, 2) == (0xff00 | end_of_image) || read_jpeg_facts(path).complete;
  return is_tiff(file.big_endian(0, 4)) ? tiff_is_complete(path) : is_untruncated(path);
}

}  // namespace terrazzo
