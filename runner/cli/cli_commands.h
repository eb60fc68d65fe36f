#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "core/file/file_io.h"
#include "graphs/document/problem.h"
#include "runner/cache/cache.h"
#include "runner/cli/command.h"

/// The commands, one file per group. Each function adds its commands to the program.
namespace terrazzo {

/// Runs the program; returns one of the exit codes below.
int run_command_line(int argc, const char* const* argv);

inline constexpr int exit_done = 0;
inline constexpr int exit_failed = 1;  ///< a node failed, or something could not be written
inline constexpr int exit_usage = 2;   ///< bad usage or an invalid graph
inline constexpr int exit_cancelled = 130;

/// A wrong value on the command line; becomes exit code 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// Runs something whose errors are the command line's fault, but for those of files and graphs.
template <typename Act>
auto as_usage(const Act& act) {
  try {
    return act();
  } catch (const FileError&) {
    throw;
  } catch (const GraphError&) {
    throw;
  } catch (const Error& e) {
    throw UsageError(e.what());
  }
}

void add_run_command(Command& program);
void add_synth_command(Command& program);
void add_check_command(Command& program);
void add_new_command(Command& program);
void add_document_commands(Command& program);
void add_node_commands(Command& program);
void add_cache_command(Command& program);
void add_compare_command(Command& program);
void add_library_command(Command& program);
void add_farm_commands(Command& program);
/// Manual pages and completions, made from all commands of `program`, which must live as long as they do.
void add_shell_commands(Command& program, const std::string& version);

/// Throws UsageError, before the run, unless the option's file can be written. Accepts an empty `path`.
void check_writable(const char* option, const std::string& path);
/// Whether a contact sheet's name asks for a page, not for a picture.
bool is_page(const std::filesystem::path& path);
/// Throws UsageError unless the name of `--sheet` says a format: a page, or a picture. Accepts an empty `path`.
void check_sheet(const std::string& path);
/// Replaces advice for graph authors in a message about a material's `folder` by advice for commands without node
/// parameters. `name_option`: what picks a material, such as "--name ".
std::string for_command_line(std::string message, const std::string& folder,
                             const std::string& name_option = "--name ");
/// Parses "512M", "2G", "1.5 GiB" into bytes. Throws UsageError.
uint64_t parse_bytes(const std::string& text, const std::string& option);
/// 1536 MiB as "1.5 GiB".
std::string shown_bytes(uint64_t bytes);

}  // namespace terrazzo
