#pragma once

#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "runner/cache/cache.h"
#include "runner/cache/cache_folder.h"
#include "runner/cache/cache_pins.h"

/// What the parts of the cache share.
namespace terrazzo {

struct Cache::State {
  State(std::filesystem::path given, uint64_t bytes);

  std::filesystem::path given_folder;
  uint64_t limit;
  CacheFolder folder;
  Pins pins;

  /// Once per text.
  void warn(const std::string& text);
  /// The cache could not be written.
  void warn_unwritten(const Error& why);
  /// Removes an entry that cannot be used.
  void discard(const std::filesystem::path& path, const Error& why);
  std::vector<std::string> take_warnings();

 private:
  std::mutex mutex_;
  std::vector<std::string> warnings_;
  std::set<std::string> said_;
};

}  // namespace terrazzo
