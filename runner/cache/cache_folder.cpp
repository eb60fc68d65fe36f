#include "runner/cache/cache_folder.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <string_view>

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/block_file/bytes.h"
#include "core/file/atomic_file.h"
#include "core/file/file_io.h"

namespace terrazzo {

namespace {

constexpr std::array<std::string_view, 3> kind_folders = {"values", "stages", "files"};
constexpr std::string_view value_suffix = ".tzv", history_suffix = ".txt", temporary_suffix = ".tmp";
/// The resolution of times of use, so that reading the cache does not constantly write to it.
constexpr int64_t use_granularity_ns = 3600 * ns_per_second;

void note_use(const char* path, const struct stat& status) {
  if (now_ns() - ns_of(status.st_mtim) > use_granularity_ns) ::utimensat(AT_FDCWD, path, nullptr, 0);
}

/// Calls visit(name) for all entries of a folder except "." and "..".
template <typename Visit>
void for_each_name(const std::filesystem::path& folder, const Visit& visit) {
  const std::unique_ptr<DIR, int (*)(DIR*)> dir(::opendir(folder.c_str()), [](DIR* d) { return ::closedir(d); });
  if (!dir) return;
  while (const dirent* entry = ::readdir(dir.get())) {
    const std::string_view name = entry->d_name;
    if (name != "." && name != "..") visit(std::string(name));
  }
}

std::string_view suffix_of(EntryKind kind) {
  return kind == EntryKind::value ? value_suffix : kind == EntryKind::history ? history_suffix : "";
}

void add_to_scan(CacheScan& scan, EntryKind kind, const std::filesystem::path& path) {
  struct stat status;
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return;
  const std::string name = path.filename().string();
  std::string_view stem = name;
  if (stem.ends_with(temporary_suffix)) {
    scan.temporaries.push_back({path, name.substr(0, name.rfind('-')), uint64_t(status.st_size)});
    return;
  }
  const std::string_view suffix = suffix_of(kind);
  if (!stem.ends_with(suffix)) return;
  stem.remove_suffix(suffix.size());
  Digest digest;
  if (Digest::parse(stem, digest))
    scan.entries.push_back({kind, digest, path, uint64_t(status.st_size), ns_of(status.st_mtim)});
}

}  // namespace

uint64_t CacheScan::bytes() const {
  uint64_t sum = 0;
  for (const CacheEntry& e : entries) sum += e.bytes;
  for (const TemporaryEntry& t : temporaries) sum += t.bytes;
  return sum;
}

CacheFolder::CacheFolder(const std::filesystem::path& folder) : root_(folder / "v1") {
  std::error_code failure;
  std::filesystem::create_directories(root_, failure);
  if (failure)
    throw Error(fmt::format(
        "cannot make the cache folder {}: {}; choose another, which $TERRAZZO_CACHE may name, or do without "
        "a cache",
        folder.string(), failure.message()));
  for (const std::string_view kind : kind_folders) std::filesystem::create_directory(root_ / kind, failure);
  std::filesystem::create_directory(pins(), failure);
  std::filesystem::create_directory(leases(), failure);
}

bool CacheFolder::is_in(const std::filesystem::path& folder) {
  std::error_code missing;
  return std::filesystem::is_directory(folder / "v1", missing);
}

std::filesystem::path CacheFolder::path_of(EntryKind kind, const Digest& name) const {
  const std::string hex = name.hex();
  if (kind == EntryKind::history) return history() / (hex + std::string(history_suffix));
  return fmt::format("{}/{}/{}/{}{}", root_.native(), kind_folders[size_t(kind)], hex.substr(0, 2), hex,
                     suffix_of(kind));
}

std::filesystem::path CacheFolder::temporary(const std::filesystem::path& target, const std::string& owner) {
  std::error_code failure;
  std::filesystem::create_directories(target.parent_path(), failure);
  if (failure) throw_system_error("make the folder", target.parent_path(), failure.value());
  return target.parent_path() / fmt::format("{}-{}{}", owner, temporaries_++, temporary_suffix);
}

void CacheFolder::write(const std::filesystem::path& target, const std::vector<uint8_t>& bytes,
                        const std::string& owner, bool sync) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  write_whole_file(target, text, temporary(target, owner), sync);
  note_written(bytes.size());
}

namespace {

/// Opens a small file and gets its status; nullopt if it does not exist.
std::optional<std::vector<uint8_t>> read_small(const std::filesystem::path& path, struct stat& status) {
  const File file = File::open(path, O_RDONLY | O_NONBLOCK);
  if (!file.ok() && errno == ENOENT) return std::nullopt;
  if (!file.ok() || ::fstat(file.descriptor(), &status) != 0) throw_system_error("read", path, errno);
  if (!S_ISREG(status.st_mode)) throw DamagedFile(fmt::format("{} is no regular file", path.string()));
  std::vector<uint8_t> bytes(size_t(status.st_size));
  bytes.resize(file.read_at(0, bytes.data(), bytes.size(), path));
  return bytes;
}

}  // namespace

std::optional<std::vector<uint8_t>> CacheFolder::read(const std::filesystem::path& path) {
  struct stat status;
  return read_small(path, status);
}

std::optional<std::vector<uint8_t>> CacheFolder::read_and_use(const std::filesystem::path& path) {
  struct stat status;
  auto bytes = read_small(path, status);
  if (bytes) note_use(path.c_str(), status);
  return bytes;
}

bool CacheFolder::use(const std::filesystem::path& path) {
  struct stat status;
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  note_use(path.c_str(), status);
  return true;
}

CacheScan CacheFolder::scan() const {
  CacheScan scan;
  for (size_t kind = 0; kind < kind_folders.size(); kind++) {
    const std::filesystem::path folder = root_ / kind_folders[kind];
    for_each_name(folder, [&](const std::string& two) {
      for_each_name(folder / two,
                    [&](const std::string& name) { add_to_scan(scan, EntryKind(kind), folder / two / name); });
    });
  }
  for_each_name(history(), [&](const std::string& name) { add_to_scan(scan, EntryKind::history, history() / name); });
  std::sort(scan.entries.begin(), scan.entries.end(), [](const CacheEntry& a, const CacheEntry& b) {
    return a.kind != b.kind ? a.kind < b.kind : a.name < b.name;
  });
  return scan;
}

}  // namespace terrazzo
