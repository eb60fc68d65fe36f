#include <algorithm>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/suggest.h"
#include "core/file/file_io.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/command_tree.h"
#include "runner/cli/console.h"

namespace terrazzo {

namespace {

/// The command that the words lead to.
Command found(const Command& program, const std::vector<std::string>& words) {
  const Command* at = &program;
  for (const std::string& word : words) {
    std::vector<std::string> known;
    for (const Command& c : at->commands) known.push_back(c.name());
    const auto next = std::ranges::find(known, word);
    if (next == known.end()) throw UsageError(fmt::format("unknown command {}{}", word, suggestion(word, known)));
    at = &at->commands[size_t(next - known.begin())];
  }
  return *at;
}

std::string page_name(const Command& command) {
  std::string name = command.path;
  std::ranges::replace(name, ' ', '-');
  return name + ".1";
}

/// A page for the command and each that it leads to.
void write_pages(const Command& command, const std::filesystem::path& folder, const std::string& version) {
  write_file(folder / page_name(command), man_page(command, version));
  for (const Command& c : command.commands) write_pages(c, folder, version);
}

}  // namespace

void add_shell_commands(CLI::App& app, Chosen& chosen, const std::string& version) {
  CLI::App* man = app.add_subcommand("man", "Prints a manual page, for `man -l -`");
  const auto words = std::make_shared<std::vector<std::string>>();
  const auto folder = std::make_shared<std::string>();
  CLI::Option* one = man->add_option("COMMAND", *words, "The command; the program if none is given")->type_name("");
  man->add_option("--all", *folder, "Writes the pages of all commands to this folder")->type_name("DIR")->excludes(one);
  man->footer("Example:\n  terrazzo man run | man -l -");
  man->callback([&app, &chosen, words, folder, version] {
    chosen = [&app, words, folder, version] {
      if (!folder->empty()) {
        write_pages(command_tree(app), *folder, version);
        return exit_done;
      }
      answer("{}", man_page(found(command_tree(app), *words), version));
      return exit_done;
    };
  });

  CLI::App* completion = app.add_subcommand("completion", "Prints a script that makes a shell complete commands");
  const auto shell = std::make_shared<std::string>();
  completion->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->type_name("")
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  completion->footer(
      "Example:\n"
      "  source <(terrazzo completion bash)");
  completion->callback([&app, &chosen, shell] {
    chosen = [&app, shell] {
      answer("{}", completion_script(command_tree(app), *shell));
      return exit_done;
    };
  });
}

}  // namespace terrazzo
