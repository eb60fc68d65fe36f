#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/cache/cache.h"
#include "runner/farm/frozen_graph.h"
#include "runner/farm/units.h"

/// A graph that was handed over to a farm: what does not change while it is worked on. What has been done is not
/// stored; the cache tells.
namespace terrazzo {

struct FarmJob {
  std::string name;                              ///< "walls-1a2b3c4d", after the graph file and the content
  std::string graph;                             ///< the file that was frozen, for messages
  std::string program;                           ///< "terrazzo 0.1.0", that froze it
  std::vector<std::string> targets;              ///< nodes
  std::map<std::string, std::string> variables;  ///< of the environment, as tasks are to have them
  std::vector<std::string> plugins;              ///< files
  std::vector<Unit> units;                       ///< in an order in which they can be made
  Digest document;                               ///< see FrozenGraph
  std::map<std::string, Digest> inputs;          ///< the content of input files, by path below FarmFolder::inputs
  std::map<std::string, Digest> keys;            ///< of nodes, without what their wires bring
  std::map<std::string, std::string> origins;    ///< see FrozenGraph
  std::map<std::string, std::string> left_out;   ///< by node, as the user's graph has it: why it is not in the job

  const Unit* find(std::string_view unit) const;
};

/// The name of a job.
std::string job_name(const std::filesystem::path& graph, const Digest& id);

/// Does nothing if the folder holds this job already; returns whether it wrote. Throws FileError.
bool write_farm_job(const FarmJob& job, const std::filesystem::path& folder);
/// Throws DamagedJob if the folder holds none, or it has been altered or damaged: its digest is in it.
FarmJob read_farm_job(const std::filesystem::path& folder);

/// Throws DamagedJob that names the file if an input that the node's parameters name has been lost or altered, or
/// another file lies beside it. Reads all of them.
void check_inputs(const FarmJob& job, const GraphNode& node, const std::filesystem::path& folder);

/// A message in which frozen inputs are called by the names of the files that they are copies of.
std::string with_original_names(std::string message, const FarmJob& job, const std::filesystem::path& folder);

/// Why a unit could not be made, or how often its process died: for people, and for the units that need it.
struct UnitFailure {
  std::string message;
  uint64_t memory = 0;  ///< bytes that it was given when it was killed; 0 if it was not
};

/// None if it has not failed since it was last handed over.
std::optional<UnitFailure> failure_of(const std::filesystem::path& folder, const std::string& unit);
void write_failure(const std::filesystem::path& folder, const std::string& unit, const UnitFailure& failure);
/// Also if there is none.
void forget_failure(const std::filesystem::path& folder, const std::string& unit);

}  // namespace terrazzo
