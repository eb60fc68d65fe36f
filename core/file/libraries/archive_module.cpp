#include <algorithm>
#include <cerrno>
#include <utility>
#include <vector>

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <locale.h>

#include "core/file/archive.h"
#include "core/file/atomic_file.h"
#include "core/file/file_io.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

using Archive = std::unique_ptr<archive, int (*)(archive*)>;
using Entry = std::unique_ptr<archive_entry, void (*)(archive_entry*)>;

constexpr size_t part_size = 1 << 20;

File open_to_write(const fs::path& file, const fs::path& name_in_messages) {
  File out = File::open(file, O_WRONLY | O_CREAT | O_TRUNC);
  if (!out.ok()) throw_system_error("write", name_in_messages, errno);
  return out;
}

/// Of the tar formats GNU's, which holds names as they are; what libarchive makes in pax form depends on the locale.
class FormatWriter final : public ArchiveWriter {
 public:
  FormatWriter(const fs::path& target, ArchiveFormat format)
      : target_(target), temporary_(temporary_beside(target)), archive_(archive_write_new(), archive_write_free) {
    std::error_code failure;
    if (target.has_parent_path()) fs::create_directories(target.parent_path(), failure);
    out_ = open_to_write(temporary_, target_);
    if (format == ArchiveFormat::zip)
      archive_write_set_format_zip(archive_.get());
    else
      archive_write_set_format_gnutar(archive_.get());
    archive_write_set_bytes_in_last_block(archive_.get(), 1);  // no padding
    check(archive_write_open_fd(archive_.get(), out_.descriptor()));
  }
  ~FormatWriter() override {
    if (temporary_.empty()) return;
    std::error_code ignored;
    fs::remove(temporary_, ignored);
  }
  FormatWriter(const FormatWriter&) = delete;
  FormatWriter& operator=(const FormatWriter&) = delete;

  void add(const std::string& name, std::string_view bytes) override {
    begin(name, bytes.size());
    check(archive_write_data(archive_.get(), bytes.data(), bytes.size()));
  }
  void add_file(const std::string& name, const fs::path& file) override {
    const File in = open_to_read(file);
    const uint64_t bytes = in.size(file);
    begin(name, bytes);
    std::vector<char> part(part_size);
    for (uint64_t at = 0; at < bytes;) {
      const size_t read = in.read_at(at, part.data(), std::min<uint64_t>(part.size(), bytes - at), file);
      if (read == 0) throw Error(fmt::format("{} became shorter while it was read", file.string()));
      check(archive_write_data(archive_.get(), part.data(), read));
      at += read;
    }
  }
  void finish() override {
    check(archive_write_close(archive_.get()));
    out_.close(target_);
    publish_file(std::exchange(temporary_, {}), target_);
  }

 private:
  void begin(const std::string& name, uint64_t bytes) {
    const Entry entry(archive_entry_new(), archive_entry_free);
    archive_entry_set_pathname(entry.get(), name.c_str());
    archive_entry_set_filetype(entry.get(), AE_IFREG);
    archive_entry_set_perm(entry.get(), 0644);
    archive_entry_set_size(entry.get(), int64_t(bytes));
    check(archive_write_header(archive_.get(), entry.get()));
  }
  void check(la_ssize_t result) const {
    if (result >= 0) return;
    const int code = archive_errno(archive_.get());
    throw_system_error("write", target_, code > 0 ? code : EIO);
  }

  fs::path target_, temporary_;
  File out_;
  Archive archive_;
};

/// Gives this thread the locale C while it lives: in others libarchive converts the names of pax archives.
class NamesAsTheyAre {
 public:
  NamesAsTheyAre() : plain_(::newlocale(LC_ALL_MASK, "C", nullptr)), before_(::uselocale(plain_)) {}
  ~NamesAsTheyAre() {
    ::uselocale(before_);
    ::freelocale(plain_);
  }
  NamesAsTheyAre(const NamesAsTheyAre&) = delete;
  NamesAsTheyAre& operator=(const NamesAsTheyAre&) = delete;

 private:
  locale_t plain_, before_;
};

class TarReader final : public ArchiveReader {
 public:
  explicit TarReader(const fs::path& path)
      : path_(path), in_(open_to_read(path)), archive_(archive_read_new(), archive_read_free) {
    constexpr size_t at_once = 1 << 16;
    archive_read_support_format_tar(archive_.get());
    check(archive_read_open_fd(archive_.get(), in_.descriptor(), at_once));
  }
  bool next() override {
    const NamesAsTheyAre as_they_are;
    for (;;) {
      archive_entry* entry = nullptr;
      const int result = archive_read_next_header(archive_.get(), &entry);
      if (result == ARCHIVE_EOF) {
        require_end();
        return false;
      }
      if (result != ARCHIVE_WARN) check(result);
      const char* name = archive_entry_pathname(entry);
      name_ = name ? name : "";
      bytes_ = uint64_t(archive_entry_size(entry));
      const auto kind = archive_entry_filetype(entry);
      if (kind == AE_IFREG && !archive_entry_hardlink(entry) && archive_entry_sparse_count(entry) == 0) return true;
      if (kind != AE_IFDIR || bytes_ > 0)
        throw Error(fmt::format("{}: the archive holds \"{}\", which is not a regular file", path_.string(), name_));
    }
  }
  const std::string& name() const override { return name_; }
  uint64_t bytes() const override { return bytes_; }
  size_t read(char* out, size_t most) override {
    const la_ssize_t got = archive_read_data(archive_.get(), out, most);
    check(got);
    return size_t(got);
  }
  void extract(const fs::path& target) override {
    File out = open_to_write(target, target);
    std::vector<char> part(part_size);
    uint64_t at = 0;
    while (const size_t got = read(part.data(), part.size())) {
      out.write_at(at, part.data(), got, target);
      at += got;
    }
    out.close(target);
  }

 private:
  void check(la_ssize_t result) const {
    if (result < 0) refuse(archive_error_string(archive_.get()));
  }
  [[noreturn]] void refuse(const char* what) const {
    throw Error(fmt::format("{}: the archive is cut off or damaged ({}); get the file again from its source",
                            path_.string(), what ? what : "unknown error"));
  }
  /// libarchive takes the end of the file, too, for the end of the archive, which has a mark.
  void require_end() const {
    if (archive_read_header_position(archive_.get()) == archive_filter_bytes(archive_.get(), 0))
      refuse("its end is missing");
  }

  fs::path path_;
  File in_;
  Archive archive_;
  std::string name_;
  uint64_t bytes_ = 0;
};

}  // namespace

}  // namespace terrazzo

extern "C" __attribute__((visibility("default"))) const terrazzo::ArchiveLibrary* terrazzo_archive_library() {
  using namespace terrazzo;
  static constexpr ArchiveLibrary library = {
      [](const fs::path& target, ArchiveFormat format) -> std::unique_ptr<ArchiveWriter> {
        return std::make_unique<FormatWriter>(target, format);
      },
      [](const fs::path& archive) -> std::unique_ptr<ArchiveReader> { return std::make_unique<TarReader>(archive); }};
  return &library;
}
