#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// The commands and options of the program as data: declared here, parsed by parse_words, shown by --help, manual pages
/// and completions. Not thread-safe.
namespace terrazzo {

/// Where the value of an option goes; nothing for those that show something (--help) or have been taken before.
using OptionTarget =
    std::variant<std::monostate, bool*, int*, int64_t*, double*, std::string*, std::vector<std::string>*>;

/// An option ("-o,--out") or, without dashes, an argument ("GRAPH"). The target must outlive the parse.
struct CommandOption {
  std::string names;
  OptionTarget target;
  std::string help{};

  std::optional<std::string> value_name{};  ///< what it takes, "FILE.json"; paths begin with FILE, DIR or PATH
  std::vector<std::string> choices{};       ///< all that it takes, if these are few
  std::optional<std::pair<int, int>> limits{};
  std::function<std::string(const std::string&)> check{};  ///< returns what is wrong, or nothing
  std::vector<std::string> excludes{}, needs{};            ///< names of other options
  std::string implied{};                                   ///< its value if it is given without one
  bool is_flag = false, is_required = false, is_repeated = false, ignores_case = false, is_hidden = false;
  bool is_not_negative = false;

  std::vector<std::string> given{};  ///< after a parse: the words that were given for it

  bool is_argument() const { return !names.starts_with('-'); }
  /// "--out" of "-o,--out".
  std::string long_name() const { return names.substr(names.rfind(',') + 1); }
  /// "-o" and "--out"; none for an argument.
  std::vector<std::string> spellings() const;
  /// "FILE.json"; empty for a flag.
  std::string takes_what() const;
  bool is_path() const;

  CommandOption& takes(std::string name) { return value_name = std::move(name), *this; }
  CommandOption& required() { return is_required = true, *this; }
  /// May be given several times, each time with one value.
  CommandOption& repeated() { return is_repeated = true, *this; }
  CommandOption& one_of(std::vector<std::string> all) { return choices = std::move(all), *this; }
  CommandOption& any_case() { return ignores_case = true, *this; }
  CommandOption& from_to(int least, int most) { return limits = std::pair(least, most), *this; }
  CommandOption& not_negative() { return is_not_negative = true, *this; }
  CommandOption& checked_by(std::function<std::string(const std::string&)> f) { return check = std::move(f), *this; }
  CommandOption& not_with(std::string other) { return excludes.push_back(std::move(other)), *this; }
  CommandOption& only_with(std::string other) { return needs.push_back(std::move(other)), *this; }
  CommandOption& implies(std::string value) { return implied = std::move(value), *this; }
  CommandOption& hidden() { return is_hidden = true, *this; }
};

/// A command, or the program itself. References to its parts stay valid as parts are added.
struct Command {
  std::string path;  ///< "terrazzo cache status"
  std::string help{}, footer{};
  std::list<CommandOption> options{};
  std::list<Command> commands{};
  std::function<int()> run{};  ///< what it does once its options are set; returns the exit code

  /// With --help.
  Command(std::string path, std::string help);

  std::string name() const { return path.substr(path.rfind(' ') + 1); }

  /// With this one's footer, until it gets its own.
  Command& add_command(const std::string& name, std::string help);
  /// An option, or an argument. One whose target is a vector takes any number of values.
  CommandOption& add_option(std::string names, OptionTarget target, std::string help);
  CommandOption& add_flag(std::string names, OptionTarget target, std::string help);

  /// Null if it has none of this name, such as "--set" or "GRAPH".
  const CommandOption* find_option(const std::string& name) const;
  std::vector<std::string> command_names() const;
  /// All spellings: "-o", "--out". Without arguments.
  std::vector<std::string> option_names() const;
};

/// What the words of a command line ask for.
struct ParsedWords {
  enum class Request { run, help, version, nothing_known };
  Request request = Request::run;
  const Command* command = nullptr;    ///< the innermost command that was named; never null
  std::string text{};                  ///< the help, or what is wrong
  std::vector<std::string> unknown{};  ///< words that nothing takes
};

/// Parses the words behind the program's name into the targets of `program`. `version`: what --version prints.
ParsedWords parse_words(Command& program, const std::string& version, int argc, const char* const* argv);

}  // namespace terrazzo
