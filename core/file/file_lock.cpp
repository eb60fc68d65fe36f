#include "core/file/file_lock.h"

#include <cerrno>
#include <thread>

#include <sys/file.h>

namespace terrazzo {

bool lock_file(const File& file, int operation) {
  int result;
  do result = ::flock(file.descriptor(), operation);
  while (result != 0 && errno == EINTR);
  return result == 0;
}

bool lock_file_soon(const File& file, int operation, std::chrono::milliseconds patience) {
  constexpr std::chrono::milliseconds pause{2};
  const auto last = std::chrono::steady_clock::now() + patience;
  while (!lock_file(file, operation | LOCK_NB)) {
    if (errno != EWOULDBLOCK || std::chrono::steady_clock::now() > last) return false;
    std::this_thread::sleep_for(pause);
  }
  return true;
}

}  // namespace terrazzo
