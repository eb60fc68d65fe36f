#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace terrazzo {

struct ToolResult {
  int exit_code = 0;  ///< 127 if there is no such program; 128 and the signal if one ended it
  std::string out, err;

  bool ok() const { return exit_code == 0; }
};

/// Runs another program to its end, found by $PATH, and collects what it prints. It gets the variables of this
/// process's environment whose names `passes`; all of them if that is empty. Throws Error only if processes cannot be
/// started at all. Thread-safe.
ToolResult run_tool(const std::vector<std::string>& words, const std::function<bool(std::string_view)>& passes = {});

}  // namespace terrazzo
