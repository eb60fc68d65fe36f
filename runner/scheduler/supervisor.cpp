#include "runner/scheduler/supervisor.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <thread>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/file/file_io.h"
#include "runner/farm/costs.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int exit_cancelled = 130;

struct Ended {
  int status = 0;
  UnitCost cost;

  bool by_signal() const { return WIFSIGNALED(status); }
  int code() const { return by_signal() ? 128 + WTERMSIG(status) : WEXITSTATUS(status); }
};

double seconds_of(const timeval& t) {
  return double(t.tv_sec) + double(t.tv_usec) / 1e6;
}

/// Starts a process and waits for its end; forwards cancellation once.
Ended run_process(const std::vector<std::string>& words, const std::atomic<bool>* cancelled) {
  std::vector<char*> arguments;
  for (const std::string& w : words) arguments.push_back(const_cast<char*>(w.c_str()));
  arguments.push_back(nullptr);
  const auto start = Clock::now();
  pid_t process = 0;
  const int failure = ::posix_spawn(&process, arguments[0], nullptr, nullptr, arguments.data(), environ);
  if (failure != 0) throw Error(fmt::format("cannot start {}: {}", words.front(), system_message(failure)));
  Ended end;
  rusage usage{};
  bool is_told = false;
  for (;;) {
    const pid_t got = ::wait4(process, &end.status, WNOHANG, &usage);
    if (got == process) break;
    if (got < 0 && errno != EINTR) throw Error(fmt::format("lost a process: {}", system_message(errno)));
    if (cancelled && *cancelled && !is_told) {
      ::kill(process, SIGTERM);
      is_told = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  end.cost.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  end.cost.cpu_seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  end.cost.memory = uint64_t(usage.ru_maxrss) * 1024;
  return end;
}

/// Runs one unit, with several attempts if necessary.
int run_one(const fs::path& folder, const Unit& unit, const Supervision& how) {
  std::vector<std::string> words = how.words;
  words.insert(words.end(), {folder.string(), unit.name});
  for (int attempt = 1;; attempt++) {
    const Ended end = run_process(words, how.cancelled);
    if (end.code() == 0) {
      remember_cost(how.costs, unit.kind, end.cost);
      forget_failure(folder, unit.name);
      return 0;
    }
    if (how.cancelled && *how.cancelled) return exit_cancelled;
    if (!end.by_signal()) return end.code();  // it has reported and recorded the reason
    const std::string signal = ::strsignal(WTERMSIG(end.status));
    if (attempt == attempts_of_a_unit) {
      const std::string message = fmt::format(
          "its process was ended {} times ({}), at last after {:.1f} s with {} MiB of memory; if it takes "
          "more than it is given, submit again: it then gets twice as much",
          attempt, signal, end.cost.seconds, end.cost.memory >> 20);
      write_failure(folder, unit.name, {message, how.memory});
      if (how.told) how.told(fmt::format("\"{}\": {}", unit.name, message));
      return end.code();
    }
    if (how.told) how.told(fmt::format("\"{}\": its process was ended ({}); starting it again", unit.name, signal));
  }
}

}  // namespace

int run_units(const fs::path& folder, const FarmJob& job, const std::vector<std::string>& units,
              const Supervision& how) {
  for (const auto& [name, value] : job.variables) ::setenv(name.c_str(), value.c_str(), 1);
  int code = 0;
  for (const std::string& name : units) {
    const Unit* unit = job.find(name);
    if (!unit) throw Error(fmt::format("job {} has no unit \"{}\"", job.name, name));
    const int ended = run_one(folder, *unit, how);
    if (ended != 0) code = ended;
    if (ended == exit_cancelled) break;
  }
  return code;
}

}  // namespace terrazzo
