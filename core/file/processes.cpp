#include "core/file/processes.h"

#include <cerrno>
#include <filesystem>

#include <signal.h>

#include "core/base/hash.h"
#include "core/file/file_io.h"

namespace terrazzo {

std::string process_neighbourhood() {
  std::error_code missing;
  const std::filesystem::path processes = std::filesystem::read_symlink("/proc/self/ns/pid", missing);
  return Hasher().add(host_name()).add(processes.native()).digest().hex().substr(0, 8);
}

bool is_running(pid_t process) {
  return ::kill(process, 0) == 0 || errno != ESRCH;
}

}  // namespace terrazzo
