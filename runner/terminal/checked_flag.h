#pragma once

#include <string>

#include "runner/terminal/command.h"

namespace terrazzo {

/// Whether runs are checked: an option of every command that runs a graph. In programs that are built for debugging
/// they are if nobody says, unless $TERRAZZO_CACHE or --cache asks for a cache, which checked runs do without.
struct CheckedFlag {
  bool yes = false, no = false;  ///< as given

  /// `cache`: what --cache says.
  bool holds(const std::string& cache) const;
};

void add_checked_flag(Command& command, CheckedFlag& flag);

/// Whether the command line may lead to a checked run, before it is read.
bool may_be_checked(int argc, const char* const* argv);

}  // namespace terrazzo
