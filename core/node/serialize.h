#pragma once

#include <filesystem>

#include "core/base/task.h"
#include "core/block_file/bytes.h"
#include "core/node/value.h"

/// The file format of values, for cache entries and portable analyses: versioned, little endian, compressed in blocks,
/// each with a checksum (core/block_file/block_file.h).
namespace terrazzo {

/// Writes the value to `path` and, if `sync`, waits until it is on disk. Images are pulled strip by strip; lazy ones
/// become stored pixels under the same digest. `seconds`: the time it took to compute, stored for cache eviction.
/// Throws Error, and leaves no file, if the disk is full or the folder cannot be written; Cancelled.
void save_value(const Value& value, const std::filesystem::path& path, const Task& task, double seconds = 0,
                bool sync = true);

/// Reads what save_value wrote, with the same digest. Verifies every checksum; pixels are read when pulled, and
/// verified again, so that a pull can throw too. The file may be removed meanwhile, but not rewritten. Throws
/// DamagedFile if it is damaged, truncated, of another format or of a newer version, Error if it cannot be read.
/// Thread-safe.
Value load_value(const std::filesystem::path& path);

/// The header of a value file.
struct ValueFileSummary {
  ValueType type = ValueType::image;
  Digest digest;
  double seconds = 0;
};
/// Verifies only the header and the length of the file. Throws as load_value.
ValueFileSummary summarize_value_file(const std::filesystem::path& path);

/// The size of the exemplar that a saved index was made from, without reading more than that. Throws as load_value for
/// damage in the parts that it reads.
Size exemplar_of_index_file(const std::filesystem::path& path);

}  // namespace terrazzo
