#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "runner/cache/cache_records.h"

/// The approximate size of the cache, in v1/total. Runs add the bytes they have written, so that they need not scan all
/// entries. The size is recounted when it reaches the limit, once a day, and after the death of a process that may have
/// written without recording it.
namespace terrazzo {

/// Nullopt if the file is missing, damaged or too old.
std::optional<CacheTotal> read_total(const std::filesystem::path& path);
/// Replaces the file atomically. Ignores errors: without the file the entries are recounted. `owner`: as in
/// CacheFolder::temporary.
void write_total(const std::filesystem::path& path, const CacheTotal& total, const std::string& owner);

}  // namespace terrazzo
