#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/task.h"
#include "graphs/text/problem.h"
#include "runner/plan/plan.h"

namespace terrazzo {

/// Errors of needed stages that can be found before the run.
struct PreflightProblems {
  /// Errors of single nodes, such as unreadable sources or sizes that do not fit. Nodes that do not depend on them can
  /// still run.
  std::vector<Problem> of_nodes;
  /// Errors that prevent the whole run: folders that cannot be written, two sinks that write the same file, too little
  /// memory.
  std::vector<Problem> of_run;
};

/// Runs infer, preflight and memory_ahead of the needed stages. Checks output files only of stages that will write
/// them. Sets Stage::shape.
PreflightProblems preflight_problems(Plan& plan);

/// Problems for image files of needed stages that exceed the limit in bytes. Call this before a plan reads the files
/// for its keys.
std::vector<Problem> oversize_problems(const Plan& plan);

/// The same checks for nodes of a document that has errors and cannot be planned, see LoadOptions::look_ahead.
std::vector<Problem> preflight_of_nodes(const std::vector<GraphNode>& nodes);

struct FileToWrite {
  std::filesystem::path path;
  bool is_pattern = false;  ///< the name is not known yet; * stands for unknown parts
  std::string node;
};
/// The files that needed stages will write or have written.
std::vector<FileToWrite> files_to_write(const Plan& plan);

/// Valid but probably unintended settings in a checked graph (see NodeType::lint). Throws Cancelled.
std::vector<Problem> lint_of(const Graph& graph, const Task& task);

}  // namespace terrazzo
