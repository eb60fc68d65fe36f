#pragma once

#include <string>
#include <vector>

#include "graphs/document/load.h"
#include "runner/cli/written_files.h"

namespace CLI {
class App;
}

namespace terrazzo {

/// Which graph a command works on, and with which values.
struct GraphFlags {
  std::string graph;
  std::vector<std::string> set, presets, settings;

  /// Loads it; `options` are completed by the presets and settings files. Throws GraphError.
  LoadedGraph load(LoadOptions options) const;
  /// The files that have been named.
  std::vector<KeptFile> files() const;
};

/// The argument GRAPH.
void add_graph_argument(CLI::App& command, GraphFlags& flags);
/// --set, --preset and --params.
void add_value_flags(CLI::App& command, GraphFlags& flags);

/// How to set a parameter of the command's graph that was taken for an option ("--seed"); empty if it has none such.
std::string set_hint(const CLI::App& command, const std::string& option);

/// What `COMMAND GRAPH --help` adds about the graph; empty if the command takes none or none has been named. Throws
/// GraphError.
std::string help_on_graph(const CLI::App& command);

}  // namespace terrazzo
