#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace terrazzo {

struct ToolResult {
  int exit_code = 0;  ///< 127 if there is no such program; 128 and the signal if one ended it
  std::string out, err;

  bool ok() const { return exit_code == 0; }
};

/// Runs another program to its end, found by $PATH, and collects what it prints. Throws Error only if processes cannot
/// be started at all. Thread-safe.
ToolResult run_tool(const std::vector<std::string>& words);

}  // namespace terrazzo
