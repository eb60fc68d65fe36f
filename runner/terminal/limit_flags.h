#pragma once

#include <cstdint>
#include <string>

#include "runner/terminal/command.h"

namespace terrazzo {

/// Limits on memory and image sizes: options of every command that reads images.
struct LimitFlags {
  std::string memory;      ///< as given; empty: not given
  int64_t max_pixels = 0;  ///< 0: not given
  std::string max_bytes;

  /// Applies the limits to this process. Throws UsageError.
  void apply() const;
};

/// --memory, --max-pixels and --max-bytes.
void add_limit_flags(Command& command, LimitFlags& flags);

}  // namespace terrazzo
