#pragma once

#include <chrono>

#include "core/file/file_io.h"

/// Locks between processes, and between open files of one. They end with the process.
namespace terrazzo {

/// flock(2), uninterrupted; false if it fails, and errno says why.
bool lock_file(const File& file, int operation);

/// The same, but waits for a limited time: who holds the lock may have been stopped. After that, errno is EWOULDBLOCK.
bool lock_file_soon(const File& file, int operation, std::chrono::milliseconds patience);

}  // namespace terrazzo
