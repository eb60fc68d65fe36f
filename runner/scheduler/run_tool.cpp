#include "runner/scheduler/run_tool.h"

#include <array>
#include <cerrno>
#include <csignal>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/file/file_io.h"

namespace terrazzo {

namespace {

/// Both ends are close-on-exec, for programs started concurrently.
struct Pipe {
  File reading, writing;

  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw Error(fmt::format("cannot make a pipe: {}", system_message(errno)));
    reading = File(ends[0]);
    writing = File(ends[1]);
  }
};

/// The file actions and attributes of posix_spawn.
struct Spawning {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;

  Spawning() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
  }
  Spawning(const Spawning&) = delete;
  Spawning& operator=(const Spawning&) = delete;
  ~Spawning() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
};

/// Reads both pipes until they end, so that neither fills up while the other is being read.
void read_both(const File& out, const File& err, ToolResult& result) {
  std::array<pollfd, 2> open = {{{out.descriptor(), POLLIN, 0}, {err.descriptor(), POLLIN, 0}}};
  const std::array<std::string*, 2> texts = {&result.out, &result.err};
  while (open[0].fd >= 0 || open[1].fd >= 0) {
    if (::poll(open.data(), open.size(), -1) < 0 && errno != EINTR) return;
    for (size_t i = 0; i < open.size(); i++) {
      if (open[i].fd < 0 || open[i].revents == 0) continue;
      char bytes[4096];
      const ssize_t count = ::read(open[i].fd, bytes, sizeof bytes);
      if (count > 0)
        texts[i]->append(bytes, size_t(count));
      else if (count == 0 || errno != EINTR)
        open[i].fd = -1;
    }
  }
}

}  // namespace

ToolResult run_tool(const std::vector<std::string>& words, const std::function<bool(std::string_view)>& passes) {
  Pipe out, err;
  Spawning how;
  posix_spawn_file_actions_addopen(&how.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&how.actions, out.writing.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&how.actions, err.writing.descriptor(), STDERR_FILENO);
  // Ctrl-C should reach only this program, which decides how to stop the other.
  posix_spawnattr_setflags(&how.attributes, POSIX_SPAWN_SETPGROUP);

  std::vector<char*> arguments;
  for (const std::string& w : words) arguments.push_back(const_cast<char*>(w.c_str()));
  arguments.push_back(nullptr);
  std::vector<char*> variables;
  for (char** v = environ; *v; v++)
    if (const std::string_view text = *v; !passes || passes(text.substr(0, text.find('=')))) variables.push_back(*v);
  variables.push_back(nullptr);
  ToolResult result;
  pid_t process = 0;
  const int failure =
      ::posix_spawnp(&process, arguments[0], &how.actions, &how.attributes, arguments.data(), variables.data());
  if (failure != 0) {
    result.exit_code = 127;
    result.err = fmt::format("cannot start {}: {}", words.front(), system_message(failure));
    return result;
  }
  out.writing = File();
  err.writing = File();
  read_both(out.reading, err.reading, result);
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

}  // namespace terrazzo
