#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/cache/cache.h"
#include "runner/farm/frozen_graph.h"
#include "runner/farm/units.h"

/// A graph submitted to a farm: the immutable part of a job. Its progress is not stored but derived from the cache.
namespace terrazzo {

struct FarmJob {
  std::string name;                              ///< "walls-1a2b3c4d", after the graph file and the content
  std::string graph;                             ///< the frozen file, for messages
  std::string program;                           ///< the version that froze it: "terrazzo 0.1.0"
  std::vector<std::string> targets;              ///< nodes
  std::map<std::string, std::string> variables;  ///< environment variables for the tasks
  std::vector<std::string> plugins;              ///< files
  std::vector<Unit> units;                       ///< in a valid order of execution
  Digest document;                               ///< see FrozenGraph
  std::map<std::string, Digest> inputs;          ///< the content of input files, by path below FarmFolder::inputs
  std::map<std::string, Digest> keys;            ///< by node: keys without inputs, see key_on_farm
  std::map<std::string, std::string> origins;    ///< see FrozenGraph
  std::map<std::string, std::string> left_out;   ///< by node of the user's graph: why it is not in the job

  const Unit* find(std::string_view unit) const;
};

/// The name of a job.
std::string job_name(const std::filesystem::path& graph, const Digest& id);

/// Writes the job unless the folder already holds it; returns whether it wrote. Throws FileError.
bool write_farm_job(const FarmJob& job, const std::filesystem::path& folder);
/// Throws DamagedJob if the folder holds no job, or if its digest is wrong.
FarmJob read_farm_job(const std::filesystem::path& folder);

/// Throws DamagedJob that names the file if an input of the node is missing or altered, or if there is another file
/// beside it. Reads all inputs.
void check_inputs(const FarmJob& job, const GraphNode& node, const std::filesystem::path& folder);

/// Replaces the paths of frozen inputs in a message by those of the original files.
std::string with_original_names(std::string message, const FarmJob& job, const std::filesystem::path& folder);

/// Why a unit failed, or how often its process died; for users, and for units that need it.
struct UnitFailure {
  std::string message;
  uint64_t memory = 0;  ///< its memory limit in bytes if it was killed; else 0
};

/// Nullopt if it has not failed since it was last submitted.
std::optional<UnitFailure> failure_of(const std::filesystem::path& folder, const std::string& unit);
void write_failure(const std::filesystem::path& folder, const std::string& unit, const UnitFailure& failure);
/// Has no effect if there is none.
void forget_failure(const std::filesystem::path& folder, const std::string& unit);

}  // namespace terrazzo
