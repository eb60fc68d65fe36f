#include "runner/cli/command_tree.h"

#include <sstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace terrazzo {

namespace {

/// "MODE:{auto,bar}" and "N:INT in [1 - 1024]": the argument's name, and what is checked.
CommandOption option_of(const CLI::Option& o) {
  CommandOption out;
  for (const std::string& n : o.get_snames()) out.names.push_back("-" + n);
  for (const std::string& n : o.get_lnames()) out.names.push_back("--" + n);
  const std::string type = o.get_type_name();
  const size_t checks = type.find(':');
  if (o.get_items_expected_max() > 0) out.argument = type.substr(0, checks);
  if (out.names.empty() && out.argument.empty()) out.argument = o.get_name(true);
  const size_t open = type.find('{'), close = type.find('}');
  if (open != type.npos && close != type.npos) {
    std::istringstream list(type.substr(open + 1, close - open - 1));
    for (std::string choice; std::getline(list, choice, ',');) out.choices.push_back(choice);
  }
  out.help = o.get_description();
  out.is_required = o.get_required();
  return out;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '-' || c == '\\') out += '\\';
    out += c;
  }
  return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

/// Lines as they are, indented ones in a fixed font.
std::string paragraphs(const std::string& text) {
  std::istringstream lines(text);
  std::string out;
  bool is_fixed = false;
  for (std::string line; std::getline(lines, line);) {
    const bool indented = line.starts_with("  ");
    if (indented != is_fixed) out += indented ? ".nf\n.ft CW\n" : ".ft\n.fi\n";
    is_fixed = indented;
    out += escaped(line) + "\n";
  }
  return out + (is_fixed ? ".ft\n.fi\n" : "");
}

std::string shown(const CommandOption& o) {
  std::string out;
  for (const std::string& n : o.names) out += (out.empty() ? "\\fB" : ", \\fB") + escaped(n) + "\\fR";
  if (!o.argument.empty()) out += (out.empty() ? "\\fI" : " \\fI") + escaped(o.argument) + "\\fR";
  return out;
}

std::string synopsis(const Command& c) {
  std::string out = fmt::format("\\fB{}\\fR", escaped(c.path));
  if (!c.commands.empty()) return out + " \\fICOMMAND\\fR ...";
  out += " [\\fIOPTIONS\\fR]";
  for (const CommandOption& o : c.options)
    if (o.names.empty() || o.is_required) out += o.is_required ? " " + shown(o) : fmt::format(" [{}]", shown(o));
  return out;
}

}  // namespace

Command command_tree(const CLI::App& app) {
  Command out;
  for (const CLI::App* a = &app; a; a = a->get_parent())
    out.path = a->get_name() + (out.path.empty() ? "" : " " + out.path);
  out.help = app.get_description();
  out.footer = app.get_footer();
  for (const CLI::Option* o : app.get_options()) out.options.push_back(option_of(*o));
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
    out.commands.push_back(command_tree(*sub));
  return out;
}

std::string man_page(const Command& command, const std::string& version) {
  std::string name = command.path;
  for (char& c : name)
    if (c == ' ') c = '-';
  std::string title = name;
  for (char& c : title) c = char(std::toupper(c));
  std::string out = fmt::format(".TH {} 1 \"\" \"{}\" \"terrazzo\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{}\n", title,
                                escaped(version), escaped(name), escaped(command.help), synopsis(command));
  if (!command.commands.empty()) {
    out += ".SH COMMANDS\n";
    for (const Command& c : command.commands)
      out += fmt::format(".TP\n\\fB{}\\fR\n{}\n", escaped(c.name()), escaped(c.help));
  }
  if (!command.options.empty()) {
    out += ".SH OPTIONS\n";
    for (const CommandOption& o : command.options) out += fmt::format(".TP\n{}\n{}\n", shown(o), escaped(o.help));
  }
  if (!command.footer.empty()) out += ".SH NOTES\n" + paragraphs(command.footer);
  return out;
}

}  // namespace terrazzo
