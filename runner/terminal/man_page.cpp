#include <sstream>

#include <fmt/format.h>

#include "runner/terminal/shell_files.h"

namespace terrazzo {

namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '-' || c == '\\') out += '\\';
    out += c;
  }
  return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

/// Keeps line breaks; indented lines are in a fixed-width font.
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
  for (const std::string& n : o.spellings()) out += (out.empty() ? "\\fB" : ", \\fB") + escaped(n) + "\\fR";
  if (const std::string takes = o.takes_what(); !takes.empty())
    out += (out.empty() ? "\\fI" : " \\fI") + escaped(takes) + "\\fR";
  return out;
}

std::string synopsis(const Command& c) {
  std::string out = fmt::format("\\fB{}\\fR", escaped(c.path));
  if (!c.commands.empty()) return out + " \\fICOMMAND\\fR ...";
  out += " [\\fIOPTIONS\\fR]";
  for (const CommandOption& o : c.options)
    if (o.is_argument() || o.is_required) out += o.is_required ? " " + shown(o) : fmt::format(" [{}]", shown(o));
  return out;
}

}  // namespace

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
    for (const CommandOption& o : command.options)
      if (!o.is_hidden) out += fmt::format(".TP\n{}\n{}\n", shown(o), escaped(o.help));
  }
  if (!command.footer.empty()) out += ".SH NOTES\n" + paragraphs(command.footer);
  return out;
}

}  // namespace terrazzo
