#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "runner/cache/cache_records.h"

/// The size of the cache as far as it is known, in v1/total: runs add to it what they have written, so that none has to
/// look at every entry. It is counted anew when it says that the limit is reached, once a day, and after a process has
/// died that may have written without telling.
namespace terrazzo {

/// None if it is missing, damaged, or too old to be believed.
std::optional<CacheTotal> read_total(const std::filesystem::path& path);
/// Replaces the file at once; ignores errors: without it the entries are counted. `owner`: as in
/// CacheFolder::temporary.
void write_total(const std::filesystem::path& path, const CacheTotal& total, const std::string& owner);

}  // namespace terrazzo
