#include "core/base/processes.h"

#include <array>
#include <cerrno>
#include <filesystem>

#include <signal.h>
#include <unistd.h>

#include "core/base/hash.h"

namespace terrazzo {

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "host";
}

std::string pid_namespace_id() {
  std::error_code missing;
  const std::filesystem::path processes = std::filesystem::read_symlink("/proc/self/ns/pid", missing);
  return Hasher().add(host_name()).add(processes.native()).digest().hex().substr(0, 8);
}

bool is_running(pid_t process) {
  return ::kill(process, 0) == 0 || errno != ESRCH;
}

}  // namespace terrazzo
