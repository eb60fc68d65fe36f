#pragma once

#include <string>

namespace terrazzo {

/// A message about the folder of a material, which advises the writer of a graph, with advice for someone who has named
/// `folder` to a command that takes no parameters of nodes.
std::string for_command_line(std::string message, const std::string& folder);

}  // namespace terrazzo
