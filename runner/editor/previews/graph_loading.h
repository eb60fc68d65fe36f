#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "graphs/document/load.h"
#include "runner/editor/previews/wishes.h"
#include "runner/engine/sandbox.h"

namespace terrazzo {

/// A document that may have mistakes, loaded as far as it can run.
struct EditedGraph {
  std::shared_ptr<const LoadedGraph> loaded;  ///< null if nothing can be loaded
  bool is_part = false;  ///< only nodes without mistakes were loaded: places in messages are not those of the document
  std::vector<Problem> problems{};
  /// Parameters that have no value yet, as warnings: nodes that need them are left out of the graph.
  std::vector<Problem> unset{};
  std::filesystem::file_time_type begun{};  ///< when loading it began
};

/// Loads a document. If it has problems, loads the nodes without them, or, if a problem is in no node, what these nodes
/// need of it. Reads only what the sandbox allows. Never
/// throws because of the document.
EditedGraph load_for_editing(const std::string& text, const std::filesystem::path& file,
                             const std::vector<NodeOfDocument>& wanted, const Sandbox& sandbox);

/// Loads a document without mistakes with other values, as `run --set` does; their relative paths are the document's.
/// Throws GraphError and Error.
EditedGraph load_variation(const std::string& text, const std::filesystem::path& file, std::vector<Override> overrides,
                           const Sandbox& sandbox);

/// The nodes to run instead of sinks: what those read, and what nobody reads. `names`: which are meant; empty: all.
std::vector<std::string> without_sinks(const Graph& graph, const std::vector<std::string>& names);

/// Runs `act`, which reads files that a graph names, with the sandbox's ReadGuard.
void within(const Sandbox& sandbox, const std::function<void()>& act);

}  // namespace terrazzo
