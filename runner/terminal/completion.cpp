#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/base/shell_words.h"
#include "runner/terminal/shell_files.h"

namespace terrazzo {

namespace {

/// Only the first sentence, since space is limited.
std::string brief(const std::string& help) {
  const size_t end = std::min(help.find(". "), help.find("; "));
  return help.substr(0, end);
}

bool takes_files(const CommandOption& o) {
  return o.is_path() || o.names == "GRAPH";
}

/// Words that complete a command's arguments besides files.
std::string suggested_arguments(const Command& c) {
  std::vector<std::string> words;
  for (const CommandOption& o : c.options)
    if (o.is_argument()) words.insert(words.end(), o.suggestions.begin(), o.suggestions.end());
  return fmt::format("{}", fmt::join(words, " "));
}

/// The words that complete an option's value: its only values, or some of them.
std::string suggested_values(const CommandOption& o) {
  return fmt::format("{}", fmt::join(o.choices.empty() ? o.suggestions : o.choices, " "));
}

/// The data for bash on each command: subcommands, options, and options with values.
void add_to_bash(const Command& c, std::string& tables) {
  std::vector<std::string> options;
  for (const CommandOption& o : c.options)
    for (const std::string& n : o.spellings()) {
      options.push_back(n);
      if (!o.takes_what().empty())
        tables += fmt::format("_terrazzo_values[{}]={}\n", shell_word(c.path + " " + n),
                              shell_word(!suggested_values(o).empty() ? suggested_values(o)
                                         : takes_files(o)             ? "=files"
                                                                      : "=text"));
    }
  tables += fmt::format("_terrazzo_commands[{}]={}\n", shell_word(c.path),
                        shell_word(fmt::format("{}", fmt::join(c.command_names(), " "))));
  if (const std::string words = suggested_arguments(c); !words.empty())
    tables += fmt::format("_terrazzo_arguments[{}]={}\n", shell_word(c.path), shell_word(words));
  tables += fmt::format("_terrazzo_options[{}]={}\n", shell_word(c.path),
                        shell_word(fmt::format("{}", fmt::join(options, " "))));
  for (const Command& sub : c.commands) add_to_bash(sub, tables);
}

std::string for_bash(const Command& program) {
  std::string tables;
  add_to_bash(program, tables);
  return "# Completion of terrazzo for bash, made by `terrazzo completion bash`.\n"
         "declare -A _terrazzo_commands _terrazzo_options _terrazzo_values _terrazzo_arguments\n" +
         tables + R"(
_terrazzo() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} path=terrazzo word i
  for ((i = 1; i < COMP_CWORD; i++)); do
    word=${COMP_WORDS[i]}
    [[ " ${_terrazzo_commands[$path]:-} " == *" $word "* ]] && path="$path $word"
  done
  # Bash takes = for the end of a word: --option=VALUE, --option NAME=VALUE.
  local given=
  [[ $cur == = ]] && i=$((COMP_CWORD - 1)) cur=
  [[ $prev == = ]] && i=$((COMP_CWORD - 2))
  if ((i < COMP_CWORD)); then
    if [[ ${COMP_WORDS[i]} == -* ]]; then prev=${COMP_WORDS[i]}; else given=${COMP_WORDS[i]}= prev=${COMP_WORDS[i-1]}; fi
  fi
  local values=${_terrazzo_values["$path $prev"]:-} IFS=$' \t\n'
  COMPREPLY=()
  case $values in
    =files) compopt -o filenames 2>/dev/null || true; mapfile -t COMPREPLY < <(compgen -f -- "$cur"); return ;;
    =text) return ;;
    ?*) mapfile -t COMPREPLY < <(compgen -W "$values" -- "$given$cur"); COMPREPLY=("${COMPREPLY[@]#"$given"}"); return ;;
  esac
  if [[ $cur == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "${_terrazzo_options[$path]:-}" -- "$cur")
  elif [[ -n ${_terrazzo_commands[$path]:-} ]]; then
    mapfile -t COMPREPLY < <(compgen -W "${_terrazzo_commands[$path]:-}" -- "$cur")
  else
    # Bash takes a colon for the end of a word: what comes before it is there already.
    local before= words=${_terrazzo_arguments[$path]:-}
    [[ $cur == : ]] && before=$prev: cur=
    [[ $prev == : ]] && before=${COMP_WORDS[COMP_CWORD-2]}:
    if [[ -n $words && $before$cur == *:* ]]; then
      mapfile -t COMPREPLY < <(compgen -W "$words" -- "$before$cur")
      COMPREPLY=("${COMPREPLY[@]#"$before"}")
    else
      compopt -o filenames 2>/dev/null || true
      mapfile -t COMPREPLY < <(compgen -f -- "$cur" || true; [[ -n $cur ]] && compgen -W "$words" -- "$cur")
    fi
  fi
}
complete -F _terrazzo terrazzo
)";
}

std::string function_of(const std::string& path) {
  std::string out = "_";
  for (const char c : path) out += c == ' ' || c == '-' ? '_' : c;
  return out;
}

/// Escapes brackets and colons, which are special in _arguments.
std::string for_zsh(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

void add_to_zsh(const Command& c, std::string& functions) {
  std::string arguments;
  for (const CommandOption& o : c.options) {
    const std::string what =
        suggested_values(o).empty() ? (takes_files(o) ? "_files" : " ") : fmt::format("({})", suggested_values(o));
    const std::string takes = o.takes_what().empty() ? "" : fmt::format(":{}:{}", for_zsh(o.takes_what()), what);
    for (const std::string& n : o.spellings())
      arguments += " \\\n    " + shell_word(fmt::format("*{}[{}]{}", n, for_zsh(brief(o.help)), takes));
  }
  if (c.commands.empty()) {
    const std::string words = suggested_arguments(c);
    const std::string files = words.empty() ? "_files" : " _files_and " + for_zsh(words);
    functions += fmt::format("{}() {{\n  _arguments{} \\\n    {}\n}}\n", function_of(c.path), arguments,
                             shell_word("*:file:" + files));
    return;
  }
  for (const Command& sub : c.commands) add_to_zsh(sub, functions);
  std::string list;
  for (const Command& sub : c.commands)
    list += " \\\n    " + shell_word(fmt::format("{}:{}", sub.name(), brief(sub.help)));
  functions += fmt::format(
      "{0}() {{\n  if (( CURRENT > 2 )); then\n    local called=${{words[2]//-/_}}\n    shift words\n"
      "    (( CURRENT-- ))\n    (( $+functions[{0}_$called] )) && {0}_$called\n    return\n  fi\n"
      "  local -a commands=({1})\n  _describe command commands\n  _arguments{2}\n}}\n",
      function_of(c.path), list, arguments);
}

std::string zsh_script(const Command& program) {
  std::string functions = "_files_and() {\n  _files\n  compadd -- \"$@\"\n}\n";
  add_to_zsh(program, functions);
  return "#compdef terrazzo\n# Completion of terrazzo for zsh, made by `terrazzo completion zsh`.\n" + functions +
         "_terrazzo \"$@\"\n";
}

/// `within`: the commands that have been given, inner ones last.
void add_to_fish(const Command& c, const std::vector<std::string>& within, std::string& out) {
  std::string when;
  for (const std::string& w : within)
    when += fmt::format("{}__fish_seen_subcommand_from {}", when.empty() ? "" : "; and ", w);
  if (!c.commands.empty())
    when += fmt::format("{}not __fish_seen_subcommand_from {}", when.empty() ? "" : "; and ",
                        fmt::join(c.command_names(), " "));
  const std::string begin = fmt::format("complete -c terrazzo -n {}", shell_word(when));
  for (const CommandOption& o : c.options) {
    if (o.is_argument()) continue;
    out += begin;
    for (const std::string& n : o.spellings()) out += n.starts_with("--") ? " -l " + n.substr(2) : " -s " + n.substr(1);
    if (!o.takes_what().empty()) out += takes_files(o) ? " -r -F" : " -x";
    if (const std::string words = suggested_values(o); !words.empty()) out += " -a " + shell_word(words);
    out += " -d " + shell_word(brief(o.help)) + "\n";
  }
  if (const std::string words = suggested_arguments(c); !words.empty())
    out += fmt::format("{} -a {}\n", begin, shell_word(words));
  for (const Command& sub : c.commands) {
    out += fmt::format("{} -f -a {} -d {}\n", begin, sub.name(), shell_word(brief(sub.help)));
    std::vector<std::string> inner = within;
    inner.push_back(sub.name());
    add_to_fish(sub, inner, out);
  }
}

}  // namespace

std::string completion_script(const Command& program, const std::string& shell) {
  if (shell == "bash") return for_bash(program);
  if (shell == "zsh") return zsh_script(program);
  std::string out = "# Completion of terrazzo for fish, made by `terrazzo completion fish`.\n";
  add_to_fish(program, {}, out);
  return out;
}

}  // namespace terrazzo
