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

/// Telling by the file system alone that a file has not changed.
namespace terrazzo {

/// Identifies a version of a file: while it is equal, what was found in the file is still true.
struct FileStamp {
  uint64_t bytes = 0;
  int64_t modified_ns = 0;  ///< since the epoch
  int64_t changed_ns = 0;   ///< of the inode: moves even when a tool sets the modification time back
  uint64_t inode = 0;
  bool operator==(const FileStamp&) const = default;

  /// Whether a change after `at_ns` is certain to give another stamp: two changes may fall into one tick of a file
  /// system's clock, so what changed just before may change unseen.
  bool is_settled(int64_t at_ns) const;
};

inline constexpr int64_t ns_per_second = 1'000'000'000;
int64_t ns_of(const timespec& t);
/// Wall-clock time, since the epoch.
int64_t now_ns();

/// None if it is no regular file.
std::optional<FileStamp> stamp_of(const std::filesystem::path& path);
std::optional<FileStamp> stamp_of(const File& file);

/// What was found in files, for as long as these stay as they are. Of the process; bounded. Thread-safe.
template <typename Fact>
class FileFacts {
 public:
  /// What is known of the file under this name, else what `find` returns. What it throws is not remembered.
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
