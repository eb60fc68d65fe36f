#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

/// The commands and options of the program as plain data, for what is generated from them: man pages and completions.
namespace terrazzo {

struct CommandOption {
  std::vector<std::string> names;    ///< "--output", "-o"; empty: an argument
  std::string argument{};            ///< what it takes, "FILE.json"; empty: nothing
  std::vector<std::string> choices;  ///< all that it takes, if these are few
  std::string help{};
  bool is_required = false;
};

struct Command {
  std::string path;  ///< "terrazzo cache status"
  std::string help{}, footer{};
  std::vector<CommandOption> options{};
  std::vector<Command> commands{};

  std::string name() const { return path.substr(path.rfind(' ') + 1); }
};

Command command_tree(const CLI::App& app);

/// A page for `man`, in roff: of the program, or of a command that it leads to.
std::string man_page(const Command& command, const std::string& version);

/// A script that makes a shell complete commands, options, choices and files. `shell`: bash, zsh or fish.
std::string completion_script(const Command& program, const std::string& shell);

}  // namespace terrazzo
