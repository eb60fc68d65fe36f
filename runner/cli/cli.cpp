#include <algorithm>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <sstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "core/base/suggest.h"
#include "core/base/text.h"
#include "core/base/thread_limits.h"
#include "core/file/file_io.h"
#include "core/file/path_spelling.h"
#include "core/image_io/image_file.h"
#include "graphs/text/problem.h"
#include "nodes/source/maps/material_folder.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/cli_graph.h"
#include "runner/engine/checked.h"
#include "runner/report/progress.h"
#include "runner/terminal/built_with.h"
#include "runner/terminal/checked_flag.h"
#include "runner/terminal/console.h"
#include "runner/terminal/plugin_flag.h"

namespace terrazzo {

namespace {

constexpr const char* examples =
    "Examples:\n"
    "  terrazzo synth bricks/ -o out --size 2048x2048     a larger material from a folder of maps\n"
    "  terrazzo new bricks/ -o bricks.json                a graph to start from\n"
    "  terrazzo run bricks.json --set seed=7 --dry-run    what a run would do, and why\n"
    "  terrazzo nodes synthesize                          what a node type does and takes\n"
    "Exit codes: 0 done, 1 a node failed or something could not be written, 2 bad usage or an invalid graph,\n"
    "130 cancelled.";

/// Determined from the raw words, so that it is known even if parsing fails.
ProgressMode mode_of(int argc, const char* const* argv) {
  const std::vector<std::string_view> words(argv, argv + argc);
  for (size_t i = 0; i < words.size(); i++)
    if (words[i] == "--progress=json" || (words[i] == "--progress" && i + 1 < words.size() && words[i + 1] == "json"))
      return ProgressMode::json;
  return ProgressMode::plain;
}

/// An optional value cannot be distinguished from the next argument.
std::string direction_hint(const Command& command, const std::string& arg) {
  const bool direction = arg == "x" || arg == "y" || arg == "xy";
  return direction && command.find_option("--tileable") ? fmt::format("; did you mean --tileable={}?", arg) : "";
}

std::string hint_for_option(const Command& command, const std::string& arg) {
  const std::string set = set_hint(command, arg);
  return set.empty() ? suggestion(arg.substr(0, arg.find('=')), command.option_names()) : set;
}

/// The message about unknown words, with suggestions; empty if there are none. Words after an unknown command would
/// belong to it. A word after an unknown option may be its value, or be left over because the value was taken for an
/// argument.
std::string unknown_words(const ParsedWords& parsed) {
  const std::vector<std::string> commands = parsed.command->command_names();
  std::string out;
  bool is_after_option = false;
  for (const std::string& word : parsed.unknown) {
    if (!word.starts_with("-") && is_after_option) continue;
    is_after_option |= word.starts_with("-");
    const std::string line =
        word.starts_with("-") ? fmt::format("unknown option {}{}", word, hint_for_option(*parsed.command, word))
        : commands.empty()    ? fmt::format("unexpected argument {}{}", word, direction_hint(*parsed.command, word))
                              : fmt::format("unknown command {}{}", word, suggestion(word, commands));
    out += (out.empty() ? "" : "\n") + line;
    if (!word.starts_with("-") && !commands.empty()) break;
  }
  return out;
}

int usage_error(const ParsedWords& parsed, ProgressMode mode) {
  const std::string unknown = unknown_words(parsed);
  write_error(mode, std::cerr, UsageError(unknown.empty() ? parsed.text : unknown));
  if (mode != ProgressMode::json) print_message("`{} --help` says what it takes.\n", parsed.command->path);
  return exit_usage;
}

/// If a standard stream is closed at startup, the first opened file would take its place and receive messages. The
/// replacement is opened for reading only, so that writing fails as for a closed stream.
void keep_standard_streams_apart() {
  for (int opened = 0; opened >= 0 && opened <= STDERR_FILENO;) {
    opened = ::open("/dev/null", O_RDONLY);
    if (opened > STDERR_FILENO) ::close(opened);
  }
}

/// The exit code for a command that ended with `code`, whose output may be incomplete.
int with_result_written(int code, ProgressMode mode) {
  if (result_failure() == 0) return code;
  write_error(mode, std::cerr, Error("cannot write to standard output: " + system_message(result_failure())));
  return code == exit_done ? exit_failed : code;
}

}  // namespace

bool is_page(const std::filesystem::path& path) {
  return path.extension() == ".html" || path.extension() == ".htm";
}

void check_sheet(const std::string& path) {
  if (!path.empty() && !is_page(path) && !format_from(path))
    throw UsageError(fmt::format(
        "--sheet {}: the extension decides the format; expected .html for a page, or .png, .jpg, .tif or .exr", path));
}

std::string for_command_line(std::string message, const std::string& folder, const std::string& name_option) {
  const auto replace = [&](std::string_view graph_advice, const std::string& advice) {
    if (const size_t at = message.find(graph_advice); at != message.npos)
      message.replace(at, graph_advice.size(), advice);
  };
  replace(advice_on_map_names,
          fmt::format(
              "rename the files, or name them explicitly: `terrazzo run graphs/material.json --set material={} "
              "--set 'exemplar.maps={{\"base_color\": \"FILE\"}}' --set out=OUT`. A single picture may stand in the "
              "folder's place",
              folder));
  replace(advice_on_several_materials,
          fmt::format("{0}NAME picks one of them; {0}'*' takes all files as one material", name_option));
  return message;
}

namespace {

int dispatch(int argc, const char* const* argv, ProgressMode mode);

/// The output of `--help` after the words.
int help_on(const Command& program, const std::vector<std::string>& words, ProgressMode mode) {
  find_command(program, words);  // throws if there is none
  std::vector<const char*> argv = {"terrazzo"};
  for (const std::string& word : words) argv.push_back(word.c_str());
  argv.push_back("--help");
  return dispatch(int(argv.size()), argv.data(), mode);
}

void add_help_command(Command& program, ProgressMode mode) {
  Command& help = program.add_command("help", "Describes a command, like its --help");
  const auto words = std::make_shared<std::vector<std::string>>();
  help.add_option("COMMAND", words.get(), "The command; all are listed if none is given").takes("");
  help.footer = "Example:\n  terrazzo help synth";
  help.run = [&program, words, mode] { return help_on(program, *words, mode); };
}

/// There is no help on unknown words.
bool names_unknown_command(const ParsedWords& parsed) {
  return !parsed.command->commands.empty() &&
         std::ranges::any_of(parsed.unknown, [](const std::string& word) { return !word.starts_with('-'); });
}

/// Help, or the version; if a graph is given, its own help comes first.
int show_help(const ParsedWords& parsed, ProgressMode mode) {
  if (names_unknown_command(parsed)) return usage_error(parsed, mode);
  try {
    const bool is_help = parsed.request == ParsedWords::Request::help;
    const std::string about_graph = is_help ? help_on_graph(*parsed.command) : "";
    print_result("{}{}", about_graph.empty() ? "" : about_graph + "\n", parsed.text);
    return exit_done;
  } catch (const Error& e) {
    write_error(mode, std::cerr, e);
    return exit_usage;
  }
}

/// Throws UsageError for a path in Windows spelling: a file named "scans\\brick" is never intended.
void check_paths(const Command& command) {
  for (const CommandOption& option : command.options) {
    if (!option.is_path()) continue;
    for (const std::string& path : option.given) {
      std::error_code failure;
      const std::string advice = path_advice(std::filesystem::current_path(failure), path);
      if (!advice.empty()) throw UsageError(fmt::format("{} {}: {}", option.long_name(), path, advice));
    }
  }
}

void add_commands(Command& program, ProgressMode mode) {
  program.add_flag("--version", {}, "Display program version information and exit");
  program
      .add_option("--plugin", {},
                  "Loads node types from a shared library; may be given several times, also after a command")
      .takes("FILE.so");
  program.footer = examples;
  add_run_command(program);
  add_synth_command(program);
  add_new_command(program);
  add_edit_command(program);
  add_check_command(program);
  add_document_commands(program);
  add_node_commands(program);
  add_cache_command(program);
  add_library_command(program);
  add_farm_commands(program);
  add_compare_command(program);
  add_blender_command(program);
  add_shell_commands(program, "terrazzo " TERRAZZO_VERSION);
  add_help_command(program, mode);
}

/// Executes the parsed command line; returns the exit code.
int dispatch(int argc, const char* const* argv, ProgressMode mode) {
  Command program("terrazzo",
                  "terrazzo turns a small PBR material into as much new, non-repeating material as a scene needs.");
  add_commands(program, mode);
  try {
    const ParsedWords parsed = parse_words(program, built_with(), argc, argv);
    using Request = ParsedWords::Request;
    if (parsed.request == Request::nothing_known) return usage_error(parsed, mode);
    if (parsed.request != Request::run) return show_help(parsed, mode);
    check_paths(*parsed.command);
    return parsed.command->run();
  } catch (const GraphError& e) {
    write_error(mode, std::cerr, e);
    return exit_usage;
  } catch (const UsageError& e) {
    write_error(mode, std::cerr, e);
    return exit_usage;
  } catch (const Cancelled& e) {
    write_error(mode, std::cerr, e);
    return exit_cancelled;
  } catch (const std::exception& e) {
    write_error(mode, std::cerr, e);
    return exit_failed;
  }
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  keep_standard_streams_apart();
  std::signal(SIGXFSZ, SIG_IGN);  // exceeding `ulimit -f` is then reported as a write error
  if (may_be_checked(argc, argv)) start_watching(argv);
  // OpenEXR's own threads would add to --threads. The user's setting takes precedence.
  ::setenv("OPENIMAGEIO_OPTIONS", "exr_threads=-1", 0);
  const ProgressMode mode = mode_of(argc, argv);
  try {
    require_stack();
  } catch (const Error& e) {
    write_error(mode, std::cerr, e);
    return exit_failed;
  }
  CommandLine line;
  try {
    line = without_plugins(argc, argv);
    load_plugins(line.plugins);
  } catch (const Error& e) {
    write_error(mode, std::cerr, e);
    return exit_usage;
  }
  return with_result_written(dispatch(int(line.words.size()), line.words.data(), mode), mode);
}

}  // namespace terrazzo
