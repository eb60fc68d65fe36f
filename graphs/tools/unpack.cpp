#include <algorithm>
#include <chrono>
#include <set>

#include <fcntl.h>
#include <fmt/format.h>

#include "core/file/archive.h"
#include "core/file/atomic_file.h"
#include "core/file/file_io.h"
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

/// The names of files, as they are unpacked.
using FileNames = std::set<std::string>;

std::string name_in_place(const std::string& name) {
  return fs::path(name).lexically_normal().string();
}

/// The files in a pack. Throws Error if the file is not a pack.
FileNames files_in(const fs::path& pack) {
  std::vector<std::string> listed;
  const std::unique_ptr<ArchiveReader> reader = read_archive(pack);
  while (reader->next()) listed.push_back(reader->name());
  const auto has = [&](const char* name) { return std::ranges::find(listed, name) != listed.end(); };
  if (!has("graph.json") || !has("settings.json"))
    throw Error(fmt::format(
        "{}: expected a pack (terrazzo pack), found an archive without graph.json and settings.json", pack.string()));
  FileNames names;
  for (const std::string& name : listed) {
    if (!is_safe(name))
      throw Error(
          fmt::format("{}: the pack holds a file of a name that packs do not have: \"{}\"", pack.string(), name));
    if (!names.insert(name_in_place(name)).second)
      throw Error(fmt::format("{}: the pack holds \"{}\" twice", pack.string(), name_in_place(name)));
  }
  for (const std::string& name : names)
    for (fs::path above = fs::path(name).parent_path(); !above.empty(); above = above.parent_path())
      if (names.contains(above.string()))
        throw Error(fmt::format("{}: the pack holds \"{}\" as a file and as a folder, of \"{}\"", pack.string(),
                                above.string(), name));
  return names;
}

/// Calls `visit(name, reader)` for files of these names only: the pack may have changed since they were found safe.
template <typename Visit>
void for_each_file(const fs::path& pack, const FileNames& names, const Visit& visit) {
  const std::unique_ptr<ArchiveReader> reader = read_archive(pack);
  while (reader->next())
    if (const std::string name = name_in_place(reader->name()); names.contains(name)) visit(name, *reader);
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
  Copy(const fs::path& pack, const FileNames& names, const fs::path& place)
      : pack_(pack), names_(names), place_(place) {
    for (const std::string& name : names) {
      const fs::path file = place / name;
      files_.insert(file);
      for (fs::path folder = file.parent_path(); folder != place; folder = folder.parent_path())
        folders_.insert(folder);
    }
  }

  void mend() {
    remove_others(place_);
    FileNames altered;
    for_each_file(pack_, names_, [&](const std::string& name, ArchiveReader& reader) {
      if (!holds(place_ / name, reader)) altered.insert(name);
    });
    if (altered.empty()) return;
    for_each_file(pack_, altered,
                  [&](const std::string& name, ArchiveReader& reader) { replace(place_ / name, reader); });
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

  static bool holds(const fs::path& path, ArchiveReader& reader) {
    const File file = File::open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
    if (!file.ok() || file.size(path) != reader.bytes()) return false;
    constexpr size_t part = 1 << 20;
    std::string expected(part, '\0'), found(part, '\0');
    for (uint64_t at = 0; at < reader.bytes(); at += part) {
      const size_t bytes = reader.read(expected.data(), part);
      if (file.read_at(at, found.data(), part, path) != bytes || expected.compare(0, bytes, found, 0, bytes) != 0)
        return false;
    }
    return true;
  }

  /// Written outside the copy until complete, since others may be listing its folders.
  void replace(const fs::path& file, ArchiveReader& reader) const {
    std::error_code failure;
    fs::create_directories(file.parent_path(), failure);
    const fs::path temporary = temporary_beside(place_);
    reader.extract(temporary);
    publish_file(temporary, file);
  }

  const fs::path& pack_;
  const FileNames& names_;
  const fs::path& place_;
  std::set<fs::path> files_, folders_;
};

}  // namespace

bool is_pack(const fs::path& file) {
  return is_archive(file);
}

std::string graph_in_pack(const fs::path& pack) {
  files_in(pack);
  std::string text;
  for_each_file(pack, {"graph.json"}, [&](const std::string&, ArchiveReader& reader) {
    text.resize(reader.bytes());
    text.resize(reader.read(text.data(), text.size()));
  });
  return text;
}

fs::path unpacked(const fs::path& pack, const fs::path& folder) {
  const FileNames names = files_in(pack);
  fs::path place = folder / content_digest(pack).value_or(Digest()).hex();
  std::error_code failure;
  if (fs::is_directory(fs::symlink_status(place, failure))) {
    Copy(pack, names, place).mend();
    fs::last_write_time(place, fs::file_time_type::clock::now(), failure);
    return place;
  }
  fs::remove(place, failure);
  fs::create_directories(folder, failure);
  remove_unused(folder);
  const fs::path temporary = temporary_beside(place);
  try {
    for_each_file(pack, names, [&](const std::string& name, ArchiveReader& reader) {
      fs::create_directories((temporary / name).parent_path(), failure);
      reader.extract(temporary / name);
    });
  } catch (...) {
    fs::remove_all(temporary, failure);
    throw;
  }
  fs::rename(temporary, place, failure);
  if (failure) {  // another process was faster
    fs::remove_all(temporary, failure);
    Copy(pack, names, place).mend();
  }
  return place;
}

}  // namespace terrazzo
