#include "runner/cache/lease_folder.h"

#include <atomic>
#include <cerrno>
#include <charconv>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/processes.h"
#include "core/file/file_io.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

template <typename Number>
bool is_number(std::string_view text, Number& out) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), out);
  return !text.empty() && read.ec == std::errc() && read.ptr == text.data() + text.size();
}

void remove_folder(const fs::path& folder) {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
}

}  // namespace

std::string new_lease_holder() {
  static std::atomic<unsigned> count{0};
  return fmt::format("{}-{}-{}", pid_namespace_id(), ::getpid(), count++);
}

bool is_dead(const std::string& who) {
  const size_t first = who.find('-'), second = who.rfind('-');
  pid_t process = 0;
  return first != std::string::npos && second > first && who.substr(0, first) == pid_namespace_id() &&
         is_number(std::string_view(who).substr(first + 1, second - first - 1), process) && process > 0 &&
         !is_running(process);
}

std::optional<LeaseHolder> holder_of(const fs::path& lease) {
  std::error_code ended;
  for (fs::directory_iterator at(lease, ended), end; !ended && at != end; at.increment(ended)) {
    const std::string name = at->path().filename().string();
    const size_t dot = name.rfind('.');
    LeaseHolder holder{name.substr(0, dot)};
    if (dot != std::string::npos && is_number(std::string_view(name).substr(dot + 1), holder.beat)) return holder;
  }
  return std::nullopt;
}

bool claim_lease(const fs::path& lease, const LeaseHolder& holder) {
  const fs::path made = lease.parent_path() / fmt::format(".claim-{}", holder.who);
  if (::mkdir(made.c_str(), 0777) != 0) return false;
  int failure = 0;
  if (!File::open(made / holder.file(), O_WRONLY | O_CREAT).ok()) failure = errno;
  // Renaming a folder replaces only a missing or an empty one.
  if (failure == 0 && ::rename(made.c_str(), lease.c_str()) == 0) return true;
  if (failure == 0) failure = errno == ENOTEMPTY ? EEXIST : errno;
  remove_folder(made);
  if (failure == ENOTDIR && ::unlink(lease.c_str()) == 0) failure = EEXIST;  // a file of an earlier version
  if (failure == EEXIST) ::rmdir(lease.c_str());  // some file systems do not replace an empty folder
  errno = failure;
  return false;
}

bool renew_lease(const fs::path& lease, LeaseHolder& holder) {
  LeaseHolder next = holder;
  next.beat++;
  if (::rename((lease / holder.file()).c_str(), (lease / next.file()).c_str()) != 0) return false;
  holder = next;
  return true;
}

void release_lease(const fs::path& lease, const LeaseHolder& holder) {
  if (::unlink((lease / holder.file()).c_str()) == 0) ::rmdir(lease.c_str());
}

void take_lease_away(const fs::path& lease, const LeaseHolder& seen) {
  ::unlink((lease / seen.file()).c_str());
}

}  // namespace terrazzo
