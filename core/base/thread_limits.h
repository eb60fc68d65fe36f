#pragma once

namespace terrazzo {

/// Starts so many threads at once, and ends them: libraries that find they cannot start theirs abort or wait for ever.
/// Takes some 20 microseconds a thread. Throws Error that names the limits on threads. Thread-safe.
void require_threads(int count);

/// Lets the main thread's stack and those of new threads grow to at least 8 MiB, as code and libraries expect. Call it
/// first in a program. Throws Error that names the limit if the system does not allow at least 512 KiB.
void require_stack();

}  // namespace terrazzo
