#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/task.h"
#include "graphs/text/problem.h"
#include "runner/plan/plan.h"

namespace terrazzo {

/// Certain failures of needed stages.
struct PreflightProblems {
  /// What a node itself is certain to refuse: a source that cannot be read, sizes that do not fit. What does not need
  /// the node can run all the same.
  std::vector<Problem> of_nodes;
  /// What the run must not begin: folders that cannot be written, two sinks that write one file, too little memory.
  std::vector<Problem> of_run;
};

/// Stages whose files are up to date write none. Notes in the plan what shapes stages will have.
PreflightProblems preflight_problems(Plan& plan);

/// Images that needed stages read and that are larger than may be read, told from the size of the files alone: to be
/// asked before a plan reads them for its keys.
std::vector<Problem> oversize_problems(const Plan& plan);

/// All that preflight_problems finds, for nodes of a document that cannot be planned, see LoadOptions.
std::vector<Problem> preflight_of_nodes(const std::vector<GraphNode>& nodes);

struct FileToWrite {
  std::filesystem::path path;
  bool is_pattern = false;  ///< its name is not known yet; * stands for what is missing
  std::string node;
};
/// The files that needed stages are going to write, or have written.
std::vector<FileToWrite> files_to_write(const Plan& plan);

/// What is allowed in a checked graph and probably unintended (see NodeType::lint). Throws Cancelled.
std::vector<Problem> lint_of(const Graph& graph, const Task& task);

}  // namespace terrazzo
