#include "core/integrity/picture_ends.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/text.h"
#include "core/integrity/file_numbers.h"

namespace terrazzo {

namespace {

/// The text before the first zero byte.
std::string until_zero(const std::string& bytes) {
  return bytes.substr(0, bytes.find('\0'));
}

struct ExrAttribute {
  uint64_t at = 0, bytes = 0;
};

using ExrHeader = std::map<std::string, ExrAttribute>;

/// The attributes of the header at `at`, which moves to its end. Nullopt if the file ends earlier.
std::optional<ExrHeader> exr_header(const FileNumbers& file, uint64_t& at) {
  constexpr size_t longest_name = 256, most_attributes = 10000;
  ExrHeader out;
  for (size_t i = 0; i < most_attributes && at < file.size(); i++) {
    const std::string name = until_zero(file.text(at, longest_name));
    at += name.size() + 1;
    if (name.empty()) return out;
    at += until_zero(file.text(at, longest_name)).size() + 1;
    const uint64_t bytes = file.number(at, 4);
    out[name] = {at + 4, bytes};
    at += 4 + bytes;
  }
  return std::nullopt;
}

/// The headers of all parts; `at` moves to the tables of offsets. Empty if the file ends earlier.
std::vector<ExrHeader> exr_headers(const FileNumbers& file, bool has_parts, uint64_t& at) {
  constexpr size_t most_parts = 10000;
  std::vector<ExrHeader> out;
  while (out.size() < most_parts) {
    const std::optional<ExrHeader> header = exr_header(file, at);
    if (!header) return {};
    if (!header->empty()) out.push_back(*header);
    if (header->empty() || !has_parts) break;
  }
  return out;
}

/// The number of entries in a part's table of offsets that belong to the picture itself; smaller levels come after
/// them. 0 if unknown.
uint64_t exr_chunks(const FileNumbers& file, const ExrHeader& header) {
  const auto window = header.find("dataWindow"), compression = header.find("compression"), tiles = header.find("tiles");
  if (window == header.end() || compression == header.end()) return 0;
  const auto side = [&](uint64_t axis) {
    const auto least = int32_t(file.number(window->second.at + 4 * axis, 4));
    const auto most = int32_t(file.number(window->second.at + 8 + 4 * axis, 4));
    return most < least ? uint64_t{0} : uint64_t(int64_t{most} - least + 1);
  };
  if (tiles != header.end()) {
    const uint64_t w = file.number(tiles->second.at, 4), h = file.number(tiles->second.at + 4, 4);
    return w == 0 || h == 0 ? 0 : ((side(0) + w - 1) / w) * ((side(1) + h - 1) / h);
  }
  // None, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB.
  constexpr uint64_t rows[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  const uint64_t kind = file.number(compression->second.at, 1);
  return kind < std::size(rows) ? (side(1) + rows[kind] - 1) / rows[kind] : 0;
}

/// Whether all of a part's picture lies in the file; its table of offsets begins at `table`.
bool exr_part_has_its_end(const FileNumbers& file, const ExrHeader& header, uint64_t table, bool has_parts) {
  const uint64_t chunks = exr_chunks(file, header);
  if (chunks > (file.size() - std::min(file.size(), table)) / 8) return false;
  uint64_t last = 0;
  const std::string offsets = file.text(table, chunks * 8);
  for (uint64_t i = 0; i < chunks; i++) {
    uint64_t offset = 0;
    for (uint64_t b = 0; b < 8; b++) offset |= uint64_t{static_cast<uint8_t>(offsets[i * 8 + b])} << 8 * b;
    if (offset == 0) return false;  // never written
    last = std::max(last, offset);
  }
  // After the number of the part: the position, then the number of bytes that follow.
  const uint64_t head = (header.contains("tiles") ? 20 : 8) + (has_parts ? 4 : 0);
  return chunks == 0 || (last <= file.size() && last + head + file.number(last + head - 4, 4) <= file.size());
}

bool exr_has_its_end(const FileNumbers& file) {
  constexpr uint64_t deep = 0x800, parts = 0x1000;
  const uint64_t flags = file.number(4, 4);
  if ((flags & deep) != 0) return true;
  const bool has_parts = (flags & parts) != 0;
  uint64_t table = 8;
  const std::vector<ExrHeader> headers = exr_headers(file, has_parts, table);
  for (const ExrHeader& header : headers) {
    if (!exr_part_has_its_end(file, header, table, has_parts)) return false;
    // Files of several parts say how long the tables are.
    if (const auto count = header.find("chunkCount"); count != header.end())
      table += 8 * file.number(count->second.at, 4);
  }
  return !headers.empty();
}

bool bmp_has_its_end(const FileNumbers& file) {
  const uint64_t packing = file.number(30, 4), bits = file.number(28, 2), width = file.number(18, 4);
  const auto rows = uint64_t(std::abs(int64_t{int32_t(file.number(22, 4))}));
  const bool is_packed = packing != 0 && packing != 3;
  if (file.number(14, 4) < 40 || is_packed) return file.number(2, 4) <= file.size();
  return file.number(10, 4) + (width * bits + 31) / 32 * 4 * rows <= file.size();
}

bool tga_has_its_end(const FileNumbers& file) {
  const uint64_t kind = file.number(2, 1), bytes = (file.number(16, 1) + 7) / 8;
  const uint64_t pixels = file.number(12, 2) * file.number(14, 2);
  uint64_t at = 18 + file.number(0, 1);
  if (file.number(1, 1) == 1) at += file.number(5, 2) * ((file.number(7, 1) + 7) / 8);
  if (kind >= 1 && kind <= 3) return at + pixels * bytes <= file.size();
  if (kind < 9 || kind > 11) return true;
  const std::string all = file.text(0, file.size());
  for (uint64_t done = 0; done < pixels;) {
    if (at >= all.size()) return false;
    const auto packet = static_cast<uint8_t>(all[at]);
    const uint64_t count = uint64_t(packet & 127) + 1;
    at += 1 + bytes * (packet >= 128 ? 1 : count);
    done += count;
  }
  return at <= all.size();
}

/// Walks the blocks to the end of the first image.
bool gif_has_its_end(const FileNumbers& file) {
  const std::string all = file.text(0, file.size());
  const auto byte = [&](size_t at) { return at < all.size() ? static_cast<uint8_t>(all[at]) : uint8_t{0}; };
  const auto palette = [](uint8_t flags) { return (flags & 128) != 0 ? size_t{3} << ((flags & 7) + 1) : size_t{0}; };
  size_t at = 13 + palette(byte(10));
  while (at < all.size()) {
    const uint8_t kind = byte(at);
    if (kind != 0x21 && kind != 0x2c) return false;
    at += kind == 0x21 ? 2 : 11 + palette(byte(at + 9));
    while (at < all.size() && byte(at) != 0) at += 1 + size_t(byte(at));
    if (at >= all.size()) return false;
    at++;
    if (kind == 0x2c) return true;
  }
  return false;
}

/// The end of a Radiance picture's run-length coded rows, which begin at `at`. 0 if the end is missing.
size_t end_of_rows(std::string_view all, size_t at, size_t width, size_t rows) {
  const auto byte = [&](size_t i) { return i < all.size() ? static_cast<uint8_t>(all[i]) : uint8_t{0}; };
  for (size_t y = 0; y < rows; y++) {
    const bool is_coded = width >= 8 && width < 32768 && byte(at) == 2 && byte(at + 1) == 2 && byte(at + 2) < 128;
    if (!is_coded) return at + 4 <= all.size() ? all.size() : 0;  // plain, or the old coding: not checked
    at += 4;
    for (size_t done = 0; done < 4 * width;) {
      if (at >= all.size()) return 0;
      const size_t count = byte(at);
      if (count == 0) return 0;
      at += count > 128 ? 2 : 1 + count;
      done += count > 128 ? count - 128 : count;
    }
  }
  return at;
}

bool hdr_has_its_end(const FileNumbers& file) {
  const std::string all = file.text(0, file.size());
  const size_t blank = all.find("\n\n"), line = all.find("-Y ", blank), x = all.find("+X ", line);
  if (blank == all.npos) return false;
  if (line != blank + 2 || x == all.npos) return true;  // rotated: not checked
  const auto number = [&](size_t at) {
    size_t v = 0;
    std::from_chars(all.data() + at, all.data() + all.size(), v);
    return v;
  };
  const size_t begin = all.find('\n', x);
  const size_t end = begin == all.npos ? 0 : end_of_rows(all, begin + 1, number(x + 3), number(line + 3));
  return end != 0 && end <= all.size();
}

}  // namespace

bool is_untruncated(const std::filesystem::path& path) {
  const FileNumbers file(path);
  const std::string start = file.text(0, 12);
  constexpr uint64_t most_walked = uint64_t{1} << 28;  // bytes, for formats that are read to their ends
  if (start.starts_with("\x76\x2f\x31\x01")) return exr_has_its_end(file);
  if (start.starts_with("BM")) return bmp_has_its_end(file);
  if (start.starts_with("RIFF") && start.ends_with("WEBP")) return file.number(4, 4) + 8 <= file.size();
  if (file.size() > most_walked) return true;
  if (start.starts_with("GIF8")) return gif_has_its_end(file);
  if (start.starts_with("#?")) return hdr_has_its_end(file);
  return lowercase(path.extension().string()) != ".tga" || tga_has_its_end(file);
}

}  // namespace terrazzo
