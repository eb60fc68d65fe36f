#include "core/file/tar.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/file/atomic_file.h"
#include "core/file/file_io.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

constexpr size_t block = 512;
constexpr size_t longest_name = 100;
constexpr uint64_t most_octal = (uint64_t{1} << 33) - 1;  // in eleven digits
constexpr uint64_t longest_pax = 1 << 16;

using Block = std::array<char, block>;

/// Fields of a header: position and length.
struct Field {
  size_t at, length;
};
constexpr Field name_field{0, 100}, mode_field{100, 8}, size_field{124, 12}, time_field{136, 12}, sum_field{148, 8},
    type_field{156, 1}, magic_field{257, 8};

void put(Block& b, Field f, std::string_view text) {
  std::copy_n(text.data(), std::min(text.size(), f.length), b.data() + f.at);
}

void put_octal(Block& b, Field f, uint64_t value) {
  put(b, f, fmt::format("{:0{}o}", value, f.length - 1));
}

uint64_t sum_of(Block b) {
  std::fill_n(b.data() + sum_field.at, sum_field.length, ' ');
  uint64_t sum = 0;
  for (const char c : b) sum += static_cast<unsigned char>(c);
  return sum;
}

std::string_view text_in(const Block& b, Field f) {
  const std::string_view all(b.data() + f.at, f.length);
  return all.substr(0, all.find('\0'));
}

std::optional<uint64_t> number_in(const Block& b, Field f) {
  uint64_t value = 0;
  if (static_cast<unsigned char>(b[f.at]) == 0x80) {  // binary, as GNU tar writes sizes from 8 GiB on
    for (size_t i = f.at + 1; i < f.at + f.length; i++) {
      if (value >> 55) return std::nullopt;
      value = value << 8 | static_cast<unsigned char>(b[i]);
    }
    return value;
  }
  for (const char c : text_in(b, f)) {
    if (c == ' ') continue;
    if (c < '0' || c > '7' || value >> 60) return std::nullopt;
    value = value * 8 + (c - '0');
  }
  return value;
}

/// "27 path=some/long/name\n"
std::string pax_record(const std::string& name) {
  const std::string rest = " path=" + name + "\n";
  size_t length = rest.size() + 1;
  while (std::to_string(length).size() + rest.size() != length) length++;
  return std::to_string(length) + rest;
}

}  // namespace

TarWriter::TarWriter(const fs::path& target) : target_(target), temporary_(temporary_beside(target)) {
  std::error_code failure;
  if (target.has_parent_path()) fs::create_directories(target.parent_path(), failure);
  out_.open(temporary_, std::ios::binary);
  write("");
}

TarWriter::~TarWriter() {
  if (temporary_.empty()) return;
  out_.close();
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void TarWriter::write(std::string_view bytes) {
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!out_) throw_system_error("write", target_, errno);
}

void TarWriter::pad(uint64_t bytes) {
  static constexpr Block zeros{};
  if (bytes % block != 0) write({zeros.data(), block - bytes % block});
}

void TarWriter::header(const std::string& name, uint64_t bytes, char type) {
  Block b{};
  put(b, name_field, name);
  put_octal(b, mode_field, 0644);
  put_octal(b, {108, 8}, 0);
  put_octal(b, {116, 8}, 0);
  put_octal(b, time_field, 0);
  if (bytes <= most_octal) {
    put_octal(b, size_field, bytes);
  } else {
    b[size_field.at] = static_cast<char>(0x80);
    for (size_t i = 0; i < 8; i++) b[size_field.at + 11 - i] = static_cast<char>(bytes >> (8 * i));
  }
  b[type_field.at] = type;
  put(b, magic_field,
      std::string_view("ustar\0"
                       "00",
                       8));
  put(b, sum_field, fmt::format("{:06o}", sum_of(b)) + std::string("\0 ", 2));
  write({b.data(), block});
}

/// What stands before a file's bytes.
void TarWriter::begin(const std::string& name, uint64_t bytes) {
  if (name.size() > longest_name) {
    const std::string record = pax_record(name);
    header("long-name", record.size(), 'x');
    write(record);
    pad(record.size());
  }
  header(name.substr(0, longest_name), bytes, '0');
}

void TarWriter::add(const std::string& name, std::string_view bytes) {
  begin(name, bytes.size());
  write(bytes);
  pad(bytes.size());
}

void TarWriter::add_file(const std::string& name, const fs::path& file) {
  const File in = open_to_read(file);
  const uint64_t bytes = in.size(file);
  begin(name, bytes);
  std::vector<char> part(1 << 20);
  for (uint64_t at = 0; at < bytes;) {
    const size_t read = in.read_at(at, part.data(), std::min<uint64_t>(part.size(), bytes - at), file);
    if (read == 0) throw Error(fmt::format("{} became shorter while it was read", file.string()));
    write({part.data(), read});
    at += read;
  }
  pad(bytes);
}

void TarWriter::finish() {
  const Block zeros{};
  write({zeros.data(), block});
  write({zeros.data(), block});
  out_.close();
  if (!out_) throw_system_error("write", target_, errno);
  publish_file(std::exchange(temporary_, {}), target_);
}

bool is_tar(const fs::path& file) {
  std::error_code missing;
  if (!fs::is_regular_file(file, missing)) return false;
  Block b{};
  std::ifstream in(file, std::ios::binary);
  in.read(b.data(), block);
  return in.gcount() == block && text_in(b, magic_field).starts_with("ustar");
}

std::vector<TarEntry> tar_entries(const fs::path& archive) {
  const auto refuse = [&](const std::string& what) { return Error(fmt::format("{}: {}", archive.string(), what)); };
  const File in = open_to_read(archive);
  const uint64_t size = in.size(archive);
  std::vector<TarEntry> out;
  std::string long_name;
  for (uint64_t at = 0; at + block <= size;) {
    Block b{};
    if (in.read_at(at, b.data(), block, archive) < block) throw refuse("the archive is cut off");
    if (std::ranges::all_of(b, [](char c) { return c == 0; })) return out;
    if (number_in(b, sum_field) != sum_of(b)) throw refuse(fmt::format("the archive is damaged at byte {}", at));
    const std::optional<uint64_t> bytes = number_in(b, size_field);
    at += block;
    if (!bytes || *bytes > size - at) throw refuse("the archive is cut off");
    const char type = b[type_field.at];
    if (type == 'x') {
      if (*bytes > longest_pax) throw refuse("a name in the archive is absurdly long");
      std::string record(*bytes, '\0');
      in.read_at(at, record.data(), record.size(), archive);
      const size_t path = record.find(" path=");
      if (path != record.npos) long_name = record.substr(path + 6, record.find('\n', path) - path - 6);
    } else if (type == '0' || type == '\0') {
      out.push_back({long_name.empty() ? std::string(text_in(b, name_field)) : long_name, at, *bytes});
      long_name.clear();
    } else if (type != '5') {
      throw refuse(fmt::format("the archive holds \"{}\", which is not a regular file", text_in(b, name_field)));
    }
    at += (*bytes + block - 1) / block * block;
  }
  throw refuse("the archive is cut off");
}

void extract(const fs::path& archive, const TarEntry& entry, const fs::path& target) {
  const File in = open_to_read(archive);
  std::ofstream out(target, std::ios::binary);
  std::vector<char> part(1 << 20);
  for (uint64_t done = 0; done < entry.bytes && out;) {
    const size_t read =
        in.read_at(entry.offset + done, part.data(), std::min<uint64_t>(part.size(), entry.bytes - done), archive);
    if (read == 0) throw Error(fmt::format("{} became shorter while it was read", archive.string()));
    out.write(part.data(), static_cast<std::streamsize>(read));
    done += read;
  }
  out.close();
  if (!out) throw_system_error("write", target, errno);
}

}  // namespace terrazzo
