#include "runner/terminal/command.h"

#include <algorithm>
#include <sstream>

namespace terrazzo {

std::vector<std::string> CommandOption::spellings() const {
  std::vector<std::string> out;
  std::istringstream list(names);
  for (std::string name; !is_argument() && std::getline(list, name, ',');) out.push_back(name);
  return out;
}

std::string CommandOption::takes_what() const {
  if (is_flag) return "";
  return value_name && !value_name->empty() ? *value_name : is_argument() ? names : "TEXT";
}

bool CommandOption::is_path() const {
  const std::string what = takes_what();
  return what.starts_with("FILE") || what.starts_with("DIR") || what.starts_with("PATH");
}

Command::Command(std::string path, std::string help) : path(std::move(path)), help(std::move(help)) {
  add_flag("-h,--help", {}, "Print this help message and exit");
}

Command& Command::add_command(const std::string& name, std::string help) {
  Command& command = commands.emplace_back(path + " " + name, std::move(help));
  command.footer = footer;
  return command;
}

CommandOption& Command::add_option(std::string names, OptionTarget target, std::string help) {
  return options.emplace_back(CommandOption{std::move(names), target, std::move(help)});
}

CommandOption& Command::add_flag(std::string names, OptionTarget target, std::string help) {
  CommandOption& flag = add_option(std::move(names), target, std::move(help));
  flag.is_flag = true;
  return flag;
}

const CommandOption* Command::find_option(const std::string& name) const {
  for (const CommandOption& option : options)
    if (option.names == name || std::ranges::count(option.spellings(), name) > 0) return &option;
  return nullptr;
}

std::vector<std::string> Command::command_names() const {
  std::vector<std::string> names;
  for (const Command& c : commands) names.push_back(c.name());
  return names;
}

std::vector<std::string> Command::option_names() const {
  std::vector<std::string> names;
  for (const CommandOption& o : options)
    for (const std::string& name : o.spellings()) names.push_back(name);
  return names;
}

}  // namespace terrazzo
