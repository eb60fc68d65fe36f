#pragma once

#include <string>
#include <vector>

/// `--plugin FILE`: an option of every command, allowed at any position.
namespace terrazzo {

/// The words of a command line.
struct CommandLine {
  std::vector<const char*> words;    ///< without --plugin and its values
  std::vector<std::string> plugins;  ///< files
};

/// Splits off the --plugin options. Throws UsageError if one has no file.
CommandLine without_plugins(int argc, const char* const* argv);

/// Loads these plug-ins and the ones in TERRAZZO_PLUGINS. Throws UsageError if one cannot be loaded.
void load_plugins(const std::vector<std::string>& files);

}  // namespace terrazzo
