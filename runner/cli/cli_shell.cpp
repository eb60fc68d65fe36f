#include <algorithm>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "core/file/file_io.h"
#include "runner/cli/cli_commands.h"
#include "runner/terminal/console.h"
#include "runner/terminal/shell_files.h"

namespace terrazzo {

namespace {

std::string page_name(const Command& command) {
  std::string name = command.path;
  std::ranges::replace(name, ' ', '-');
  return name + ".1";
}

/// Pages for the command and all its subcommands.
void write_pages(const Command& command, const std::filesystem::path& folder, const std::string& version) {
  write_file(folder / page_name(command), man_page(command, version));
  for (const Command& c : command.commands) write_pages(c, folder, version);
}

}  // namespace

const Command& find_command(const Command& program, const std::vector<std::string>& words) {
  const Command* at = &program;
  for (const std::string& word : words) {
    const auto next = std::ranges::find_if(at->commands, [&](const Command& c) { return c.name() == word; });
    if (next == at->commands.end())
      throw UsageError(fmt::format("unknown command {}{}", word, suggestion(word, at->command_names())));
    at = &*next;
  }
  return *at;
}

void add_shell_commands(Command& program, const std::string& version) {
  Command& man = program.add_command("man", "Prints a manual page, for `man -l -`");
  const auto words = std::make_shared<std::vector<std::string>>();
  const auto folder = std::make_shared<std::string>();
  man.add_option("COMMAND", words.get(), "The command; the program if none is given").takes("");
  man.add_option("--all", folder.get(), "Writes the pages of all commands to this folder")
      .takes("DIR")
      .not_with("COMMAND");
  man.footer = "Example:\n  terrazzo man run | man -l -";
  man.run = [&program, words, folder, version] {
    if (folder->empty())
      print_result("{}", man_page(find_command(program, *words), version));
    else
      write_pages(program, *folder, version);
    return exit_done;
  };

  Command& completion = program.add_command("completion", "Prints a script that makes a shell complete commands");
  const auto shell = std::make_shared<std::string>();
  completion.add_option("SHELL", shell.get(), "bash, zsh or fish").required().takes("").one_of({"bash", "zsh", "fish"});
  completion.footer =
      "Example:\n"
      "  source <(terrazzo completion bash)";
  completion.run = [&program, shell] {
    print_result("{}", completion_script(program, *shell));
    return exit_done;
  };
}

}  // namespace terrazzo
