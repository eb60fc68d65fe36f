#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/node/node.h"
#include "graphs/text/problem.h"

/// A graph and the values that it is to run with, for programs. The same as `terrazzo run GRAPH --set ...`: the same
/// messages, the same keys, the same bytes.
namespace terrazzo {

/// A parameter that a graph declares.
struct JobParameter {
  Param param;
  std::string group{};              ///< the heading it is listed under; may be empty
  std::optional<ParamValue> value;  ///< as it is set now; empty if it must still be set
};

/// A node as the document has it: an entry of its section `nodes`.
struct JobNode {
  std::string name;
  std::string type;      ///< as it is spelled: of a node type, or of a graph that is used as one
  bool is_known = true;  ///< false: there is no such type, or its graph cannot be read
  std::vector<Param> params{};
  std::vector<Port> inputs{}, outputs{};
};

/// What a document declares, as far as it can be read: what is wrong with it is left out.
struct JobOutline {
  std::vector<JobParameter> parameters;  ///< with the document's values
  std::vector<JobNode> nodes;
};

/// A graph that has been checked and can be planned and run. Immutable; cheap to copy; thread-safe.
class CheckedJob {
 public:
  const Graph& graph() const;
  /// What is allowed and probably unintended, and conversions that were put in.
  const std::vector<Problem>& warnings() const;

 private:
  friend class Job;
  struct State;
  std::shared_ptr<const State> state_;
};

/// A graph document with values on top. Copies are independent. Not thread-safe; different jobs are independent.
class Job {
 public:
  /// Reads a graph file. Throws GraphError if it cannot be read or is no graph.
  static Job open(const std::filesystem::path& graph);
  /// The same for text in memory; relative paths in it are relative to the folder of `as`, which need not exist.
  static Job from_text(std::string text, const std::filesystem::path& as = "graph.json");

  /// Sets a parameter of the graph, or "node.parameter", to a value. Paths are relative to the working folder. What is
  /// wrong with it is found by check() and checked().
  Job& set(const std::string& name, const ParamValue& value);
  /// The same for a value as the command line has it: "512x512", "[1, 2]", "=2 * seed", "@node".
  Job& set_text(const std::string& name, const std::string& value);
  /// Takes back what has been set under this name.
  Job& unset(const std::string& name);
  /// Sets what a preset of the graph says. Values that are set count more.
  Job& preset(const std::string& name);
  /// Sets what a file says, an object of values by name. Counts more than presets, less than values that are set.
  Job& settings(const std::filesystem::path& file);
  /// Gives a value in memory to an input that the graph declares, or in place of the output of a node that has one; the
  /// node does not run then. Its digest is in the keys, so that results are reused for the same value. checked() throws
  /// Error if there is no such input or node, or if it is of another type.
  Job& give(const std::string& name, Value value);

  /// The graph's parameters, as they are set now; in the document's order. Throws GraphError.
  std::vector<JobParameter> parameters() const;
  /// Parameters and nodes by name, for programs that offer them. Never throws GraphError.
  JobOutline outline() const;
  /// What has been set under this name, else what the document says of it, as compact JSON; empty if neither does.
  std::optional<std::string> value_of(const std::string& name) const;
  /// All problems that can be found without running; empty if the job can run. Never throws GraphError.
  std::vector<Problem> check() const;
  /// What is allowed and probably unintended; empty if there are problems.
  std::vector<Problem> warnings() const;
  /// The JSON pointer (RFC 6901) to what a problem is about, also if that has been set; empty if it is elsewhere.
  std::string pointer_to(const Problem& problem) const;
  /// The graph, ready to run; with `only`, what these nodes need must be set and nothing else. Throws GraphError with
  /// all problems.
  CheckedJob checked(const std::vector<std::string>& only = {}) const;

  /// The document with the values that have been set written into it; all its other bytes, comments too, stay. It is to
  /// lie in `folder`: relative paths that have been set, which lie in the working folder, are written so that they mean
  /// the same there. Presets, settings files and values in memory are not part of it. Throws Error for what cannot be
  /// written: what has been set inside a graph that is used as a node.
  std::string text(const std::filesystem::path& folder) const;
  /// Where the document is, or would be.
  const std::filesystem::path& path() const { return path_; }

 private:
  Job() = default;
  std::string text_;
  std::filesystem::path path_;
  std::vector<std::pair<std::string, std::string>> values_;  ///< by name, as the command line spells them
  std::vector<std::string> presets_;
  std::vector<std::filesystem::path> settings_;
  std::vector<std::pair<std::string, Value>> given_;

  std::vector<std::string> overrides() const;
};

}  // namespace terrazzo
