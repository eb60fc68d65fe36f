#pragma once

#include <chrono>

#include "core/file/file_io.h"

/// Locks between processes, and between open files of one process. They end with the process.
namespace terrazzo {

/// flock(2), restarted after signals; returns false on failure, with errno set.
bool lock_file(const File& file, int operation);

/// The same with a timeout, since the holder may be a stopped process. After the timeout errno is EWOULDBLOCK.
bool lock_file_soon(const File& file, int operation, std::chrono::milliseconds patience);

}  // namespace terrazzo
