#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace terrazzo::test {

/// What a run of the real program gave.
struct ProgramRun {
  int code = -1;  ///< exit code, or 128 + signal
  std::string out;
  std::string err;
};

/// Runs the program in `folder` with a cache and a library of its own there, and waits for it.
ProgramRun run_program(const std::filesystem::path& folder, const std::vector<std::string>& args);

/// The program running by itself, its standard error in `folder`/stderr.
class StartedProgram {
 public:
  StartedProgram(const std::filesystem::path& folder, const std::vector<std::string>& args);
  ~StartedProgram();
  StartedProgram(const StartedProgram&) = delete;
  StartedProgram& operator=(const StartedProgram&) = delete;
  void signal(int number) const;
  /// Waits until its standard error contains the text, or a long time has passed.
  bool says(const std::string& text) const;
  ProgramRun wait();
  /// Watches it until it ends: the most memory that it has had at once, in KiB. What the system counts itself includes
  /// the memory of this process, which it was forked from.
  long watch_memory() const;

 private:
  std::filesystem::path folder_;
  int pid_ = -1;
};

}  // namespace terrazzo::test
