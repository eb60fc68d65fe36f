#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// The program's commands and options as data, used for parsing (parse_words), --help, manual pages and completions.
/// Not thread-safe.
namespace terrazzo {

/// The variable that receives an option's value; monostate for options that print something (--help) or are handled
/// elsewhere.
using OptionTarget =
    std::variant<std::monostate, bool*, int*, int64_t*, double*, std::string*, std::vector<std::string>*>;

/// An option ("-o,--out") or, without dashes, an argument ("GRAPH"). The target must outlive the parse.
struct CommandOption {
  std::string names;
  OptionTarget target;
  std::string help{};

  /// The placeholder of its value, "FILE.json". That of a path begins with FILE, DIR or PATH.
  std::optional<std::string> value_name{};
  std::vector<std::string> choices{};      ///< the allowed values, if they are few
  std::vector<std::string> suggestions{};  ///< values for completion, among others
  std::optional<std::pair<int, int>> limits{};
  std::function<std::string(const std::string&)> check{};  ///< returns an error message, or an empty text
  std::vector<std::string> excludes{}, needs{};            ///< names of other options
  std::string implied{};                                   ///< its value if given without one
  bool is_flag = false, is_required = false, is_repeated = false, ignores_case = false, is_hidden = false;
  bool is_not_negative = false;

  std::vector<std::string> given{};  ///< after parsing: the words given for it

  bool is_argument() const { return !names.starts_with('-'); }
  /// "--out" of "-o,--out".
  std::string long_name() const { return names.substr(names.rfind(',') + 1); }
  /// "-o" and "--out"; empty for an argument.
  std::vector<std::string> spellings() const;
  /// "FILE.json"; empty for a flag.
  std::string takes_what() const;
  bool is_path() const;

  CommandOption& takes(std::string name) { return value_name = std::move(name), *this; }
  CommandOption& required() { return is_required = true, *this; }
  /// May be given several times, each time with one value.
  CommandOption& repeated() { return is_repeated = true, *this; }
  CommandOption& one_of(std::vector<std::string> all) { return choices = std::move(all), *this; }
  CommandOption& suggests(std::vector<std::string> some) { return suggestions = std::move(some), *this; }
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
  std::function<int()> run{};  ///< executes the command once its options are set; returns the exit code

  /// Adds --help.
  Command(std::string path, std::string help);

  std::string name() const { return path.substr(path.rfind(' ') + 1); }

  /// The new command inherits this one's footer.
  Command& add_command(const std::string& name, std::string help);
  /// Adds an option or an argument. If the target is a vector it takes any number of values.
  CommandOption& add_option(std::string names, OptionTarget target, std::string help);
  /// The target is a bool, or a text for `implies`.
  CommandOption& add_flag(std::string names, OptionTarget target, std::string help);

  /// Finds an option by name, such as "--set" or "GRAPH"; null if there is none.
  const CommandOption* find_option(const std::string& name) const;
  std::vector<std::string> command_names() const;
  /// All spellings of options: "-o", "--out". Excludes arguments.
  std::vector<std::string> option_names() const;
};

/// The result of parsing a command line.
struct ParsedWords {
  enum class Request { run, help, version, nothing_known };
  Request request = Request::run;
  const Command* command = nullptr;    ///< the innermost named command; never null
  std::string text{};                  ///< the help text, or the error message
  std::vector<std::string> unknown{};  ///< words that match no option or argument
};

/// Parses the words after the program's name into the targets of `program`. `version`: the text that --version prints.
ParsedWords parse_words(Command& program, const std::string& version, int argc, const char* const* argv);

}  // namespace terrazzo
