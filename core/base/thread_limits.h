#pragma once

namespace terrazzo {

/// Checks that `count` threads can run at once by starting them: libraries that cannot start theirs abort or hang.
/// Takes some 20 microseconds per thread. Throws Error that names the limits on threads. Thread-safe.
void require_threads(int count);

/// Raises the stack limit of the main thread and of new threads to at least 8 MiB, as code and libraries expect. Call
/// it first in a program. Throws Error that names the limit if the system does not allow at least 512 KiB.
void require_stack();

}  // namespace terrazzo
