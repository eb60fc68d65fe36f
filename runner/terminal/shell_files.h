#pragma once

#include <string>

#include "runner/terminal/command.h"

/// What shells and `man` are told of the commands.
namespace terrazzo {

/// A page for `man`, in roff: of the program, or of a command that it leads to.
std::string man_page(const Command& command, const std::string& version);

/// A script that makes a shell complete commands, options, choices and files. `shell`: bash, zsh or fish.
std::string completion_script(const Command& program, const std::string& shell);

}  // namespace terrazzo
