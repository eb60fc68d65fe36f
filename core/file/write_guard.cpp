#include "core/file/write_guard.h"

#include <cerrno>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

fs::path path_of(const File& folder) {
  return fmt::format("/proc/self/fd/{}", folder.descriptor());
}

}  // namespace

fs::path WriteGuard::made_folder(const fs::path& folder) {
  if (current_ && current_->check_) return current_->hold(folder);
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw Error(fmt::format("cannot make the folder {}: {}", folder.string(), failure.message()));
  return folder;
}

fs::path WriteGuard::hold(const fs::path& folder) {
  if (const auto known = held_.find(folder); known != held_.end()) return path_of(known->second);
  constexpr int only_place = O_PATH | O_DIRECTORY;
  fs::path there = folder.empty() ? fs::path(".") : folder;
  std::vector<fs::path> missing;
  File held = File::open(there, only_place);
  for (; !held.ok() && errno == ENOENT && there.has_relative_path(); held = File::open(there, only_place)) {
    if (there.has_filename()) missing.push_back(there.filename());
    there = there.has_parent_path() ? there.parent_path() : fs::path(".");
  }
  if (!held.ok()) throw_system_error("write into", folder, errno);
  // Checks the folder's current location, not the one at the first look-up.
  std::error_code unknown;
  fs::path place = fs::read_symlink(path_of(held), unknown);
  if (unknown) throw Error(fmt::format("cannot tell where {} is: {}", folder.string(), unknown.message()));
  for (size_t i = missing.size(); i > 0; i--) place /= missing[i - 1];
  check_(place);
  for (; !missing.empty(); missing.pop_back()) {
    const fs::path& part = missing.back();
    if (::mkdirat(held.descriptor(), part.c_str(), 0777) != 0 && errno != EEXIST)
      throw_system_error("make the folder", folder, errno);
    held = File(::openat(held.descriptor(), part.c_str(), only_place | O_NOFOLLOW | O_CLOEXEC));
    if (!held.ok()) throw_system_error("write into", folder, errno);
  }
  return path_of(held_.emplace(folder, std::move(held)).first->second);
}

}  // namespace terrazzo
