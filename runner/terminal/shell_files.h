#pragma once

#include <string>

#include "runner/terminal/command.h"

/// Manual pages and shell completions.
namespace terrazzo {

/// The manual page of the program or of a subcommand, in roff.
std::string man_page(const Command& command, const std::string& version);

/// A completion script for commands, options, choices and files. `shell`: bash, zsh or fish.
std::string completion_script(const Command& program, const std::string& shell);

}  // namespace terrazzo
