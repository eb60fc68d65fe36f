#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/terminal/command.h"
#include "runner/terminal/usage.h"

/// The commands, one file per group. Each function adds its commands to the program.
namespace terrazzo {

/// Runs the program; returns one of the exit codes of usage.h.
int run_command_line(int argc, const char* const* argv);

void add_run_command(Command& program);
void add_synth_command(Command& program);
void add_check_command(Command& program);
void add_new_command(Command& program);
void add_edit_command(Command& program);
void add_document_commands(Command& program);
void add_node_commands(Command& program);
void add_cache_command(Command& program);
void add_compare_command(Command& program);
void add_blender_command(Command& program);
void add_library_command(Command& program);
void add_farm_commands(Command& program);
/// Manual pages and completions, generated from the commands of `program`, which must outlive them.
void add_shell_commands(Command& program, const std::string& version);

/// The command named by the words, such as {"cache", "gc"}; the program for none. Throws UsageError.
const Command& find_command(const Command& program, const std::vector<std::string>& words);

/// Whether a contact sheet's file name selects a page rather than a picture.
bool is_page(const std::filesystem::path& path);
/// Throws UsageError unless the file name of `--sheet` has the extension of a page or a picture. Accepts an empty
/// `path`.
void check_sheet(const std::string& path);
/// Replaces advice for graph authors in a message about a material's `folder` by advice for commands without node
/// parameters. `name_option`: the option that selects a material, such as "--name ".
std::string for_command_line(std::string message, const std::string& folder,
                             const std::string& name_option = "--name ");

}  // namespace terrazzo
