#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace terrazzo {

struct ToolResult {
  int exit_code = 0;  ///< 127 if the program does not exist; 128 plus the signal that ended it
  std::string out, err;

  bool ok() const { return exit_code == 0; }
};

/// Runs another program, found by $PATH, waits for its end and collects its output. It inherits the environment
/// variables whose names `passes` accepts; all if `passes` is empty. Throws Error only if no process can be started.
/// Thread-safe.
ToolResult run_tool(const std::vector<std::string>& words, const std::function<bool(std::string_view)>& passes = {});

}  // namespace terrazzo
