#pragma once

#include <filesystem>

#include "core/base/task.h"
#include "core/file/bytes.h"
#include "core/node/value.h"

/// One file format for every value that is kept: cache entries and portable analyses. Versioned, little endian,
/// compressed in blocks, every block with a checksum (core/file/block_file.h).
namespace terrazzo {

/// Writes the value to `path` and, if `sync`, waits until it is on the disk. Images are pulled strip by strip; what is
/// computed on demand becomes stored pixels under the same digest. `seconds`: what the value cost to compute, kept for
/// whoever manages many such files. Throws Error if the disk is full or the folder cannot be written, and leaves no
/// file then.
void save_value(const Value& value, const std::filesystem::path& path, const Task& task, double seconds = 0,
                bool sync = true);

/// Reads what save_value wrote, with the same digest. Verifies every checksum; pixels are then read from the file when
/// they are pulled, and verified again, so that a pull can throw too. The file may be removed meanwhile, but not
/// rewritten. Throws DamagedFile saying what is wrong with a file that is damaged, truncated, of another format or of a
/// newer version, Error if it cannot be read at all; it never returns a wrong value. Thread-safe.
Value load_value(const std::filesystem::path& path);

/// What a value file says about itself.
struct ValueFileSummary {
  ValueType type = ValueType::image;
  Digest digest;
  double seconds = 0;
};
/// Reads and verifies only the header, and that the file is as long as that says. Throws as load_value does.
ValueFileSummary summarize_value_file(const std::filesystem::path& path);

}  // namespace terrazzo
