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

/// Which graph a command works on, and with which values.
struct GraphFlags {
  std::string graph;
  std::vector<std::string> set, presets, settings;
  std::filesystem::path pack{};                    ///< where it is unpacked, if it is one
  std::shared_ptr<const PrivateFolder> passing{};  ///< of a pack that no cache keeps

  /// Before a load: unpacks a pack into the cache, or, without one, into a folder that goes with these flags. Throws
  /// Error and FileError.
  void open_pack(const std::optional<std::filesystem::path>& cache);
  /// The same with the usual cache, or without one if that is out of reach.
  void open_pack();
  /// The same in the cache that a run names, if any, unless it keeps nothing. Returns where: the folders to read from.
  std::vector<std::filesystem::path> unpack_for_run(bool keeps, const std::string& cache);
  /// Loads it; `options` are completed by the presets and settings files. Throws GraphError.
  LoadedGraph load(LoadOptions options) const;
  /// The files that have been named.
  std::vector<ProtectedFile> files() const;
};

/// What to say of the warnings about a graph: of many the first ones.
std::vector<std::string> shown_warnings(const std::string& graph, const std::vector<Problem>& warnings);

/// The argument GRAPH.
void add_graph_argument(Command& command, GraphFlags& flags);
/// --set, --preset and --params.
void add_value_flags(Command& command, GraphFlags& flags);

/// How to set a parameter of the command's graph that was taken for an option ("--seed"); empty if it has none such.
std::string set_hint(const Command& command, const std::string& option);

/// What `COMMAND GRAPH --help` adds about the graph; empty if the command takes none or none has been named. Throws
/// GraphError.
std::string help_on_graph(const Command& command);

}  // namespace terrazzo
