#pragma once

#include <string>

#include <sys/types.h>

namespace terrazzo {

/// What this machine is called, where several share a file system.
std::string host_name();

/// Names the processes whose numbers mean something here: those of this host that are counted together with this one.
/// Eight hexadecimal digits.
std::string pid_namespace_id();

/// Whether a process of the neighbourhood runs, or has stopped and may go on.
bool is_running(pid_t process);

}  // namespace terrazzo
