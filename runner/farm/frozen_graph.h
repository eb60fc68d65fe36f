#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "runner/engine/plan.h"

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
};

/// The needed nodes of a plan, frozen. Writes nothing; reads the content of input files, memoised by `cache`, which may
/// be null.
FrozenGraph frozen(const Plan& plan, Cache* cache);

/// Writes the document into a job's folder, and copies what is not there yet into the farm's inputs. Throws FileError,
/// also if a file has changed since it was frozen.
void write_frozen(const FrozenGraph& graph, const std::filesystem::path& job);

}  // namespace terrazzo
