#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/file/private_folder.h"
#include "graphs/document/load.h"
#include "runner/terminal/command.h"
#include "runner/terminal/written_files.h"

namespace terrazzo {

/// The graph that a command works on, and its values.
struct GraphFlags {
  std::string graph;
  std::vector<std::string> set, presets, settings;
  std::filesystem::path pack{};                    ///< where the graph is unpacked, if it is a pack
  std::shared_ptr<const PrivateFolder> passing{};  ///< temporary folder of a pack that is not kept in a cache

  /// Call before load: unpacks a pack into the cache, or, without one, into a temporary folder owned by these flags.
  /// Throws Error and FileError.
  void open_pack(const std::optional<std::filesystem::path>& cache);
  /// The same with the default cache, or without one if that is unavailable.
  void open_pack();
  /// The same with a run's cache, unless it uses none (`keeps` is false). Returns the folders to read from.
  std::vector<std::filesystem::path> unpack_for_run(bool keeps, const std::string& cache);
  /// The values of --set, whose paths a sandbox lets nodes read.
  std::vector<Override> overrides() const;
  /// Loads the graph with these values, then `more`, and with its presets and settings files added to `options`. Throws
  /// GraphError.
  LoadedGraph load(LoadOptions options, const std::vector<Override>& more = {}) const;
  /// The files named on the command line.
  std::vector<ProtectedFile> files() const;
};

/// Formats the warnings about a graph; at most the first few.
std::vector<std::string> shown_warnings(const std::string& graph, const std::vector<Problem>& warnings);

/// The names of all stock graphs, for completion; `prefix` before each.
std::vector<std::string> stock_names(std::string_view prefix = "");
/// The argument GRAPH.
void add_graph_argument(Command& command, GraphFlags& flags);
/// --set, --preset and --params.
void add_value_flags(Command& command, GraphFlags& flags);

/// A hint on how to set a parameter of the command's graph that was given as an option ("--seed"); empty if there is no
/// such parameter.
std::string set_hint(const Command& command, const std::string& option);

/// The help on the graph for `COMMAND GRAPH --help`; empty if the command takes no graph or none is given. Throws
/// GraphError.
std::string help_on_graph(const Command& command);

}  // namespace terrazzo
