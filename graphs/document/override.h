#pragma once

#include <string>
#include <vector>

#include "graphs/document/diagnostics.h"

namespace terrazzo {

/// A value given on the command line: `name=value` for a graph parameter, `node.parameter=value` (or a port) for a
/// node.
struct Override {
  std::string spelled;  ///< as given, for messages
  std::string node;     ///< empty for a graph parameter
  std::string name;
  std::string value;

  Diagnostics diagnostics(std::vector<Problem>& all) const;
};

/// How problems say (as Problem::where) that they are about the override of this spelling.
std::string where_of_override(const std::string& spelled);

/// Texts without "=" or without a name become problems.
std::vector<Override> read_overrides(const std::vector<std::string>& texts, std::vector<Problem>& problems);

}  // namespace terrazzo
