#include <algorithm>
#include <chrono>
#include <set>

#include <fcntl.h>
#include <fmt/format.h>

#include "core/file/atomic_file.h"
#include "core/file/file_io.h"
#include "core/file/tar.h"
#include "graphs/tools/pack.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

/// Whether unpacking a file of this name stays in the folder.
bool is_safe(const std::string& name) {
  const fs::path path(name);
  if (!path.lexically_normal().has_filename()) return false;
  bool goes_up = false;
  for (const fs::path& part : path) goes_up |= part == "..";
  static const std::set<std::string> own = {"graph.json", "settings.json", "sources.json"};
  return !name.empty() && !path.is_absolute() && !goes_up &&
         (own.contains(name) || name.starts_with("inputs/") || name.starts_with("loops/"));
}

/// The files in a pack. Throws Error if the file is not a pack.
std::vector<TarEntry> entries_of(const fs::path& pack) {
  std::vector<TarEntry> entries = tar_entries(pack);
  const auto has = [&](const char* name) { return std::ranges::find(entries, name, &TarEntry::name) != entries.end(); };
  if (!has("graph.json") || !has("settings.json"))
    throw Error(fmt::format(
        "{}: expected a pack (terrazzo pack), found an archive without graph.json and settings.json", pack.string()));
  std::set<fs::path> names;
  for (TarEntry& e : entries) {
    if (!is_safe(e.name))
      throw Error(
          fmt::format("{}: the pack holds a file of a name that packs do not have: \"{}\"", pack.string(), e.name));
    e.name = fs::path(e.name).lexically_normal().string();
    if (!names.insert(e.name).second)
      throw Error(fmt::format("{}: the pack holds \"{}\" twice", pack.string(), e.name));
  }
  for (const fs::path& name : names)
    for (fs::path above = name.parent_path(); !above.empty(); above = above.parent_path())
      if (names.contains(above))
        throw Error(fmt::format("{}: the pack holds \"{}\" as a file and as a folder, of \"{}\"", pack.string(),
                                above.string(), name.string()));
  return entries;
}

void remove_unused(const fs::path& folder) {
  std::error_code failure;
  const auto month = std::chrono::hours(24 * 30);
  for (const auto& entry : fs::directory_iterator(folder, failure))
    if (fs::file_time_type::clock::now() - entry.last_write_time(failure) > month) fs::remove_all(entry, failure);
}

/// Makes the copy equal to the pack's content.
class Copy {
 public:
  Copy(const fs::path& pack, const std::vector<TarEntry>& entries, const fs::path& place)
      : pack_(pack), entries_(entries), place_(place), archive_(open_to_read(pack)) {
    for (const TarEntry& e : entries) {
      const fs::path file = place / e.name;
      files_.insert(file);
      for (fs::path folder = file.parent_path(); folder != place; folder = folder.parent_path())
        folders_.insert(folder);
    }
  }

  void mend() {
    remove_others(place_);
    for (const TarEntry& e : entries_)
      if (const fs::path file = place_ / e.name; !holds(file, e)) replace(file, e);
  }

 private:
  /// Files that are not in the pack might be read along with its own.
  void remove_others(const fs::path& folder) {
    std::error_code failure;
    std::vector<fs::path> others;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failure)) {
      const fs::file_status status = entry.symlink_status(failure);
      if (fs::is_directory(status) && folders_.contains(entry.path()))
        remove_others(entry.path());
      else if (!fs::is_regular_file(status) || !files_.contains(entry.path()))
        others.push_back(entry.path());
    }
    for (const fs::path& path : others)
      if (fs::remove_all(path, failure); failure) throw_system_error("remove", path, failure.value());
  }

  bool holds(const fs::path& path, const TarEntry& entry) const {
    const File file = File::open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
    if (!file.ok() || file.size(path) != entry.bytes) return false;
    std::string expected(part, '\0'), found(part, '\0');
    for (uint64_t at = 0; at < entry.bytes; at += part) {
      const size_t bytes = std::min<uint64_t>(part, entry.bytes - at);
      if (archive_.read_at(entry.offset + at, expected.data(), bytes, pack_) != bytes ||
          file.read_at(at, found.data(), bytes, path) != bytes ||
          std::string_view(expected).substr(0, bytes) != std::string_view(found).substr(0, bytes))
        return false;
    }
    return true;
  }

  /// Written outside the copy until complete, since others may be listing its folders.
  void replace(const fs::path& file, const TarEntry& entry) const {
    std::error_code failure;
    fs::create_directories(file.parent_path(), failure);
    const fs::path temporary = temporary_beside(place_);
    extract(pack_, entry, temporary);
    publish_file(temporary, file);
  }

  static constexpr size_t part = 1 << 20;

  const fs::path& pack_;
  const std::vector<TarEntry>& entries_;
  const fs::path& place_;
  File archive_;
  std::set<fs::path> files_, folders_;
};

}  // namespace

bool is_pack(const fs::path& file) {
  return is_tar(file);
}

std::string graph_in_pack(const fs::path& pack) {
  const std::vector<TarEntry> entries = entries_of(pack);
  const TarEntry& graph = *std::ranges::find(entries, "graph.json", &TarEntry::name);
  std::string text(graph.bytes, '\0');
  open_to_read(pack).read_at(graph.offset, text.data(), text.size(), pack);
  return text;
}

fs::path unpacked(const fs::path& pack, const fs::path& folder) {
  const std::vector<TarEntry> entries = entries_of(pack);
  fs::path place = folder / content_digest(pack).value_or(Digest()).hex();
  std::error_code failure;
  if (fs::is_directory(fs::symlink_status(place, failure))) {
    Copy(pack, entries, place).mend();
    fs::last_write_time(place, fs::file_time_type::clock::now(), failure);
    return place;
  }
  fs::remove(place, failure);
  fs::create_directories(folder, failure);
  remove_unused(folder);
  const fs::path temporary = temporary_beside(place);
  try {
    for (const TarEntry& e : entries) {
      fs::create_directories((temporary / e.name).parent_path(), failure);
      extract(pack, e, temporary / e.name);
    }
  } catch (...) {
    fs::remove_all(temporary, failure);
    throw;
  }
  fs::rename(temporary, place, failure);
  if (failure) {  // another process was faster
    fs::remove_all(temporary, failure);
    Copy(pack, entries, place).mend();
  }
  return place;
}

}  // namespace terrazzo
