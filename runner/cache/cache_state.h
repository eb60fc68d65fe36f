#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "runner/cache/cache_folder.h"
#include "runner/cache/cache_leases.h"
#include "runner/cache/cache_limit.h"
#include "runner/cache/cache_pins.h"

namespace terrazzo {

/// State shared by the parts of the cache. Thread-safe.
class CacheState {
 public:
  CacheState(std::filesystem::path given, uint64_t bytes);

  std::filesystem::path given_folder;
  CacheLimit limit;
  CacheFolder folder;
  Pins pins;
  Leases leases;

  /// Adds a warning, once per text.
  void warn(const std::string& text);
  /// Warns that the cache cannot be written.
  void warn_unwritten(const Error& why);
  /// Removes a damaged entry, with a warning.
  void discard(const std::filesystem::path& path, const Error& why);
  std::vector<std::string> take_warnings();

 private:
  std::mutex mutex_;
  std::vector<std::string> warnings_;
  std::set<std::string> said_;
};

}  // namespace terrazzo
