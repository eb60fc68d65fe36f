#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "graphs/document/problem.h"
#include "runner/engine/plan.h"

namespace terrazzo {

/// Certain failures of needed stages: missing sources, folders that cannot be written, two sinks that write one file.
/// Stages whose files are up to date write none. Notes in the plan what shapes stages will have.
std::vector<Problem> preflight_problems(Plan& plan);

/// Images that needed stages read and that are larger than may be read, told from the size of the files alone: to be
/// asked before a plan reads them for its keys.
std::vector<Problem> oversize_problems(const Plan& plan);

/// The same as preflight_problems for nodes of a document that cannot be planned, see LoadOptions.
std::vector<Problem> preflight_of_nodes(const std::vector<GraphNode>& nodes);

struct FileToWrite {
  std::filesystem::path path;
  bool is_pattern = false;  ///< its name is not known yet; * stands for what is missing
  std::string node;
};
/// The files that needed stages are going to write, or have written.
std::vector<FileToWrite> files_to_write(const Plan& plan);

/// What is allowed in a checked graph and hardly meant (see NodeType::doubts).
std::vector<Problem> doubts_about(const Graph& graph);

}  // namespace terrazzo
