#include "tests/runner/program.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "test_paths.h"
#include "tests/runner/fakes.h"

namespace terrazzo::test {

namespace {

void redirect(int descriptor, const std::filesystem::path& file) {
  const int to = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  ::dup2(to, descriptor);
  ::close(to);
}

}  // namespace

StartedProgram::StartedProgram(const std::filesystem::path& folder, const std::vector<std::string>& args)
    : folder_(folder) {
  // Everything is made ready before the fork: the child of a program with threads may only make system calls.
  const std::string out = (folder / "stdout").string(), err = (folder / "stderr").string();
  std::vector<std::string> words = {TERRAZZO_PROGRAM};
  words.insert(words.end(), args.begin(), args.end());
  std::vector<char*> argv;
  for (std::string& w : words) argv.push_back(w.data());
  argv.push_back(nullptr);
  std::vector<std::string> settings = {"TERRAZZO_CACHE=" + (folder / "cache").string(),
                                       "TERRAZZO_LIBRARY=" + (folder / "library").string()};
  for (char** e = environ; *e; e++)
    if (const std::string_view s = *e; !s.starts_with("TERRAZZO_CACHE=") && !s.starts_with("TERRAZZO_LIBRARY="))
      settings.push_back(*e);
  std::vector<char*> environment;
  for (std::string& s : settings) environment.push_back(s.data());
  environment.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ != 0) return;
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) ::signal(number, SIG_DFL);  // nohup has tests ignore the last
  redirect(STDOUT_FILENO, out);
  redirect(STDERR_FILENO, err);
  if (::chdir(folder.c_str()) == 0) ::execve(TERRAZZO_PROGRAM, argv.data(), environment.data());
  ::_exit(126);
}

StartedProgram::~StartedProgram() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

void StartedProgram::signal(int number) const {
  ::kill(pid_, number);
}

bool StartedProgram::says(const std::string& text) const {
  for (int i = 0; i < 6000; i++) {
    if (read_text(folder_ / "stderr").find(text) != std::string::npos) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

long StartedProgram::watch_memory() const {
  const std::string status = fmt::format("/proc/{}/status", pid_), mark = "VmHWM:";
  long peak = 0;
  siginfo_t ended{};
  while (::waitid(P_PID, id_t(pid_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 && ended.si_pid == 0) {
    const std::string text = read_text(status);
    if (text.starts_with("Name:\tterrazzo\n"))  // and no longer this program
      if (const size_t at = text.find(mark); at != text.npos) peak = std::max(peak, std::atol(&text[at + mark.size()]));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return peak;
}

ProgramRun StartedProgram::wait() {
  int status = 0;
  ::waitpid(pid_, &status, 0);
  pid_ = -1;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_text(folder_ / "stdout"),
          read_text(folder_ / "stderr")};
}

ProgramRun run_program(const std::filesystem::path& folder, const std::vector<std::string>& args) {
  return StartedProgram(folder, args).wait();
}

}  // namespace terrazzo::test
