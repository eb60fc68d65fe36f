#pragma once

#include <string>

#include <sys/types.h>

namespace terrazzo {

/// The machine's name, which distinguishes machines on a shared file system.
std::string host_name();

/// Identifies this process's PID namespace and host, in eight hexadecimal digits. PIDs are comparable only if it is
/// equal.
std::string pid_namespace_id();

/// Whether a process of this PID namespace is running or stopped.
bool is_running(pid_t process);

}  // namespace terrazzo
