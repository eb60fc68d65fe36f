#pragma once

#include <string>

#include "runner/terminal/command.h"

namespace terrazzo {

/// The option for checked runs, of every command that runs a graph. Debug builds check by default, unless
/// $TERRAZZO_CACHE or --cache asks for a cache, which checked runs do not use.
struct CheckedFlag {
  bool yes = false, no = false;  ///< as given

  /// `cache`: the value of --cache.
  bool holds(const std::string& cache) const;
};

void add_checked_flag(Command& command, CheckedFlag& flag);

/// Whether the command line may lead to a checked run, judged before it is parsed.
bool may_be_checked(int argc, const char* const* argv);

}  // namespace terrazzo
