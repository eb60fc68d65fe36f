#pragma once

#include <string>
#include <vector>

/// `--plugin FILE`, which every command takes, wherever it stands.
namespace terrazzo {

/// The words of a command line.
struct CommandLine {
  std::vector<const char*> words;    ///< without those of --plugin
  std::vector<std::string> plugins;  ///< files
};

/// Throws UsageError if --plugin has no file.
CommandLine without_plugins(int argc, const char* const* argv);

/// Loads these, and those that TERRAZZO_PLUGINS names. Throws UsageError if one cannot be loaded.
void load_plugins(const std::vector<std::string>& files);

}  // namespace terrazzo
