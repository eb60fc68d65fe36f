#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <time.h>

#include "core/file/file_io.h"

/// Detects unchanged files by metadata only.
namespace terrazzo {

/// Identifies a version of a file: while the stamp is equal, facts about the content remain valid.
struct FileStamp {
  uint64_t bytes = 0;
  int64_t modified_ns = 0;  ///< since the epoch
  int64_t changed_ns = 0;   ///< of the inode: changes even if a tool resets the modification time
  uint64_t inode = 0;
  bool operator==(const FileStamp&) const = default;

  /// Whether any change after `at_ns` is certain to alter the stamp. Two changes may fall into one tick of the file
  /// system's clock, so a file that has just changed may change again unnoticed.
  bool is_settled(int64_t at_ns) const;
};

inline constexpr int64_t ns_per_second = 1'000'000'000;
int64_t ns_of(const timespec& t);
/// Wall-clock time, since the epoch.
int64_t now_ns();

/// Nullopt if it is no regular file.
std::optional<FileStamp> stamp_of(const std::filesystem::path& path);
std::optional<FileStamp> stamp_of(const File& file);

/// A bounded in-memory cache of facts about files, valid while the files are unchanged. Thread-safe.
template <typename Fact>
class FileFacts {
 public:
  /// The cached fact `name` about the file, else the result of `find`. Exceptions are not cached.
  template <typename Find>
  Fact of(const std::filesystem::path& path, const std::string& name, const Find& find) {
    const std::optional<FileStamp> stamp = stamp_of(path);
    const std::pair<std::string, std::string> key(path.native(), name);
    if (stamp) {
      const std::lock_guard lock(mutex_);
      if (const auto at = known_.find(key); at != known_.end() && at->second.first == *stamp) return at->second.second;
    }
    const int64_t begun = now_ns();
    Fact fact = find();
    if (stamp && stamp->is_settled(begun) && stamp_of(path) == stamp) {
      const std::lock_guard lock(mutex_);
      if (known_.size() >= most_) known_.clear();
      known_.insert_or_assign(key, std::pair(*stamp, fact));
    }
    return fact;
  }

 private:
  static constexpr size_t most_ = 10000;
  std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, std::pair<FileStamp, Fact>> known_;
};

}  // namespace terrazzo
