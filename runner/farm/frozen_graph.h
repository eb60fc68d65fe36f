#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "graphs/document/load.h"
#include "runner/plan/plan.h"

/// A graph as the machines of a farm run it: one document in which every value is written out, and copies of its input
/// files, named by content. What is edited after it was handed over changes nothing any more.
namespace terrazzo {

/// A file that a node reads, and its copy.
struct FrozenInput {
  std::filesystem::path from;
  std::filesystem::path to;  ///< below FarmFolder::inputs
  Digest content;
};

struct FrozenGraph {
  std::string text;                 ///< of the document; its relative paths are those in a job's folder
  std::vector<FrozenInput> inputs;  ///< each once
  /// By the folder below FarmFolder::inputs that copies lie in: the folder that they were copied from.
  std::map<std::string, std::string> origins;
  std::map<std::string, std::string> names;  ///< what the needed nodes of the plan are called in the document
  std::vector<std::string> targets;          ///< of these names, the ones that are to be made
  Digest id;                                 ///< of text, targets and inputs: the same job has the same

  Digest document() const { return Hasher().add("frozen document").add(text).digest(); }
};

/// The needed nodes of a plan, frozen. Writes nothing; reads the content of input files, memoised by `cache`, which may
/// be null.
FrozenGraph frozen(const Plan& plan, Cache* cache);

/// Writes the document into a job's folder, and copies input files into the farm's inputs, as far as they are not there
/// already, unaltered; removes what else lies among the copies. Returns the files that it wrote or removed. Throws
/// FileError, also if a file has changed since it was frozen.
std::vector<std::filesystem::path> write_frozen(const FrozenGraph& graph, const std::filesystem::path& job);

/// The document in a job's folder. Throws DamagedJob unless it is the one of that digest (see FrozenGraph::document).
LoadedGraph load_frozen(const std::filesystem::path& job, const Digest& document);

/// What lies among the copies of one path and is none of them, though a node would read it.
std::vector<std::filesystem::path> strangers_in(const std::filesystem::path& folder,
                                                const std::function<bool(const std::filesystem::path&)>& is_known);

}  // namespace terrazzo
