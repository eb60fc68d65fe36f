#pragma once

#include <filesystem>

#include "core/task.h"
#include "core/value.h"

/// One file format for every value that is kept: cache entries and portable analyses. Versioned, little endian,
/// compressed in blocks, every block with a checksum.
namespace terrazzo {

/// Writes the value to `path` and syncs it to disk. Images are pulled strip by strip. Throws Error if the disk is full
/// or the folder cannot be written.
void save_value(const Value& value, const std::filesystem::path& path, const Task& task);

/// Reads what save_value wrote, with the same digest. Throws Error saying what is wrong with a file that is damaged,
/// truncated, of another format or of a newer version; it never returns a wrong value. Thread-safe.
Value load_value(const std::filesystem::path& path);

}  // namespace terrazzo
