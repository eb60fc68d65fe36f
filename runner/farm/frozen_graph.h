#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "graphs/document/load.h"
#include "runner/plan/plan.h"

/// A graph frozen for a farm: one document with all values written out, and copies of its input files, named by
/// content. Later edits of the original files have no effect.
namespace terrazzo {

/// An input file of a node, and its copy.
struct FrozenInput {
  std::filesystem::path from;
  std::filesystem::path to;  ///< below FarmFolder::inputs
  Digest content;
};

struct FrozenGraph {
  std::string text;                 ///< of the document; relative paths start at the job's folder
  std::vector<FrozenInput> inputs;  ///< each once
  /// By folder of copies below FarmFolder::inputs: the folder of the originals.
  std::map<std::string, std::string> origins;
  std::map<std::string, std::string> names;  ///< names in the document, by needed node of the plan
  std::vector<std::string> targets;          ///< the targets, by name in the document
  Digest id;                                 ///< digest of text, targets and inputs; identifies the job

  Digest document() const { return Hasher().add("frozen document").add(text).digest(); }
};

/// Freezes the needed nodes of a plan. Writes nothing. Reads the content of input files, memoised by `cache`, which may
/// be null.
FrozenGraph frozen(const Plan& plan, Cache* cache);

/// Writes the document into a job's folder and copies missing or altered input files into the farm's inputs. Removes
/// other files among the copies. Returns the files that it wrote or removed. Throws FileError, also if a file has
/// changed since it was frozen.
std::vector<std::filesystem::path> write_frozen(const FrozenGraph& graph, const std::filesystem::path& job);

/// Loads the document in a job's folder. Throws DamagedJob unless it has this digest (see FrozenGraph::document).
LoadedGraph load_frozen(const std::filesystem::path& job, const Digest& document);

/// Unknown files in a folder of copies that a node would read.
std::vector<std::filesystem::path> strangers_in(const std::filesystem::path& folder,
                                                const std::function<bool(const std::filesystem::path&)>& is_known);

}  // namespace terrazzo
