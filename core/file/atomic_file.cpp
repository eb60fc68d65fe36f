#include "core/file/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <climits>
#include <cstdlib>
#include <optional>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/processes.h"
#include "core/file/file_io.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

constexpr auto trusted_age = std::chrono::hours(24);
constexpr std::string_view mark = "terrazzo";

struct Owner {
  std::string neighbourhood;
  pid_t process = 0;
};

/// From a name as `temporary_beside` makes it: .STEM.terrazzo-NEIGHBOURHOOD-PROCESS-COUNT.EXTENSION
std::optional<Owner> owner_of(const fs::path& file) {
  const std::string name = file.filename().replace_extension().string();
  const std::string start = fmt::format(".{}-", mark);
  const size_t at = name.rfind(start);
  if (!name.starts_with('.') || at == std::string::npos || at == 0) return std::nullopt;
  const std::string rest = name.substr(at + start.size());
  const size_t first = rest.find('-'), second = rest.rfind('-');
  if (first != 8 || second <= first + 1 || second + 1 == rest.size()) return std::nullopt;
  Owner owner{rest.substr(0, first), 0};
  unsigned count = 0;
  const auto is_number = [&](size_t begin, size_t end, auto& out) {
    const auto read = std::from_chars(rest.data() + begin, rest.data() + end, out);
    return read.ec == std::errc() && read.ptr == rest.data() + end;
  };
  const bool whole = is_number(first + 1, second, owner.process) && is_number(second + 1, rest.size(), count);
  return whole && owner.process > 0 ? std::optional(owner) : std::nullopt;
}

bool is_abandoned(const fs::directory_entry& entry) {
  const std::optional<Owner> owner = owner_of(entry.path());
  std::error_code failure;
  if (!owner || entry.is_symlink(failure) || !entry.is_regular_file(failure)) return false;
  if (owner->neighbourhood == pid_namespace_id()) return !is_running(owner->process);
  const fs::file_time_type written = entry.last_write_time(failure);
  return !failure && fs::file_time_type::clock::now() - written > trusted_age;
}

/// errno of creating a file or folder in an existing folder; 0 if possible. Permissions are not reliable: root has them
/// all, and /proc accepts no files even so. An unnamed file serves as a test without changing the folder's time, but
/// not all file systems support it.
int error_of_making(bool file, const fs::path& folder) {
  const int nameless = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
  if (nameless >= 0) {
    ::close(nameless);
    return 0;
  }
  const fs::path name = temporary_beside(folder / "trial");
  if (!file) return ::mkdir(name.c_str(), 0700) == 0 && ::rmdir(name.c_str()) == 0 ? 0 : errno;
  const int made = ::open(name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600);
  if (made < 0) return errno;
  ::close(made);
  ::unlink(name.c_str());
  return 0;
}

}  // namespace

namespace {

/// The nearest existing folder of a path.
fs::path existing_above(fs::path folder) {
  std::error_code failure;
  while (!fs::exists(folder, failure) && folder.has_relative_path()) folder = folder.parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

/// Why the file system rejects such names; empty if it accepts them. `there`: an existing folder.
std::string too_long(const fs::path& there, const fs::path& path) {
  const long asked = ::pathconf(there.c_str(), _PC_NAME_MAX);
  const size_t most = asked > 0 ? size_t(asked) : 255;
  for (const fs::path& part : path)
    if (part.native().size() > most)
      return fmt::format("the name {} is too long: {} bytes; names have at most {} here", part.string(),
                         part.native().size(), most);
  std::error_code failure;
  const size_t whole = fs::absolute(path, failure).native().size();
  if (whole >= PATH_MAX)
    return fmt::format("the path {} is too long: {} bytes; paths have at most {}", path.string(), whole, PATH_MAX - 1);
  return "";
}

}  // namespace

std::string why_not_writable(const fs::path& folder, const std::string& name) {
  fs::path there = folder.empty() ? fs::path(".") : folder;
  if (std::string trouble = too_long(existing_above(there), folder / name); !trouble.empty()) return trouble;
  std::error_code failure;
  fs::file_status status = fs::status(there, failure);
  const bool is_there = fs::exists(status);
  while (status.type() == fs::file_type::not_found && there != there.parent_path()) {
    if (fs::is_symlink(fs::symlink_status(there, failure)))
      return fmt::format("the folder {} is a link to {}, which is not there", there.string(),
                         fs::read_symlink(there, failure).string());
    there = there.has_parent_path() ? there.parent_path() : fs::path(".");
    status = fs::status(there, failure);
  }
  if (failure) return fmt::format("cannot access the folder {}: {}", there.string(), failure.message());
  if (!fs::is_directory(status)) return fmt::format("expected a folder to write to, found the file {}", there.string());
  const bool forbidden = ::faccessat(AT_FDCWD, there.c_str(), W_OK | X_OK, AT_EACCESS) != 0;
  if (const int error = forbidden ? errno : error_of_making(is_there, there); error != 0)
    return fmt::format("cannot write into the folder {}: {}; write to another folder", there.string(),
                       error == ENOENT ? "no file can be created there" : system_message(error));
  if (!name.empty() && fs::is_directory(folder / name, failure))
    return fmt::format("expected the name of a file to write, found the folder {}", (folder / name).string());
  return "";
}

fs::path temporary_beside(const fs::path& target) {
  static std::atomic<unsigned> count{0};
  // Names have at most 255 bytes; the beginning is for people only, and no format has a long extension.
  const std::string beginning = target.stem().string().substr(0, 100);
  const std::string extension = target.extension().string().substr(0, 50);
  return target.parent_path() /
         fmt::format(".{}.{}-{}-{}-{}{}", beginning, mark, pid_namespace_id(), ::getpid(), count++, extension);
}

namespace {

/// Follows a chain of links; the last target need not exist. Throws FileError for cycles.
fs::path behind_links(const fs::path& path) {
  constexpr int most_links = 40;  // as many as Linux follows
  std::error_code none;
  fs::path place = path;
  for (int i = 0; i < most_links; i++) {
    if (!fs::is_symlink(fs::symlink_status(place, none))) return place;
    place = place.parent_path() / fs::read_symlink(place, none);
  }
  throw_system_error("write", path, ELOOP);
}

/// Writes a file with the mode and owner of another. Only its owner may read it before it has them.
void write_like(const struct stat& other, const fs::path& path, std::string_view bytes) {
  const File file(::open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600));
  if (!file.ok()) throw_system_error("write", path, errno);
  write_file(path, bytes);
  // Not all users may give files away, and not all file systems have owners and modes. The mode comes last: a new owner
  // takes bits off it.
  [[maybe_unused]] const bool has_owner = ::fchown(file.descriptor(), other.st_uid, other.st_gid) == 0;
  [[maybe_unused]] const bool has_mode = ::fchmod(file.descriptor(), other.st_mode & 07777) == 0;
}

}  // namespace

void publish_file(const fs::path& temporary, const fs::path& target, bool sync) {
  if (::rename(temporary.c_str(), target.c_str()) != 0) {
    const int code = errno;
    ::unlink(temporary.c_str());
    throw_system_error("write", target, code);
  }
  if (!sync) return;
  if (const File folder = File::open(target.parent_path(), O_RDONLY | O_DIRECTORY); folder.ok())
    ::fsync(folder.descriptor());
}

void write_whole_file(const fs::path& target, std::string_view bytes, const fs::path& temporary, bool sync) {
  try {
    write_file(temporary, bytes, sync);
  } catch (const FileError& e) {
    ::unlink(temporary.c_str());
    throw_system_error("write", target, e.code());
  }
  publish_file(temporary, target, sync);
}

void write_whole_file(const fs::path& target, std::string_view bytes) {
  const fs::path place = behind_links(target);
  struct stat before {};
  const bool is_there = ::stat(place.c_str(), &before) == 0;
  if (is_there && !S_ISREG(before.st_mode)) return write_file(target, bytes);
  std::error_code missing;
  if (place.has_parent_path()) fs::create_directories(place.parent_path(), missing);
  const fs::path temporary = temporary_beside(place);
  if (!is_there) return write_whole_file(place, bytes, temporary);
  try {
    write_like(before, temporary, bytes);
  } catch (const FileError& e) {
    ::unlink(temporary.c_str());
    throw_system_error("write", target, e.code());
  }
  publish_file(temporary, place);
}

void remove_abandoned(const fs::path& folder) {
  std::vector<fs::path> abandoned;
  std::error_code ended;
  for (fs::directory_iterator at(folder, ended), end; !ended && at != end; at.increment(ended))
    if (is_abandoned(*at)) abandoned.push_back(at->path());
  for (const fs::path& file : abandoned) fs::remove(file, ended);
}

}  // namespace terrazzo
