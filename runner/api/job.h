#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/node/node.h"
#include "graphs/text/problem.h"
#include "graphs/values/override.h"

/// A graph and the values to run it with, for programs. Equivalent to `terrazzo run GRAPH --set ...`: the same
/// messages, cache keys and bytes.
namespace terrazzo {

/// A parameter that a graph declares.
struct JobParameter {
  Param param;
  std::string group{};              ///< the heading it is listed under; may be empty
  std::optional<ParamValue> value;  ///< its current value; empty if it must still be set
};

/// A node in the document: an entry of its section `nodes`.
struct JobNode {
  std::string name;
  std::string type;      ///< as the document spells it: a node type, or a graph used as one
  bool is_known = true;  ///< false: the type does not exist, or its graph cannot be read
  std::vector<Param> params{};
  std::vector<Port> inputs{}, outputs{};
};

/// The valid declarations of a document; faulty ones are left out.
struct JobOutline {
  std::vector<JobParameter> parameters;  ///< with the document's values
  std::vector<JobNode> nodes;
};

/// A graph that has been checked and can be planned and run. Immutable; cheap to copy; thread-safe.
class CheckedJob {
 public:
  const Graph& graph() const;
  /// Valid but probably unintended settings, and implicit conversions.
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
  /// The same for text in memory. Relative paths in it start at the folder of `as`, which need not exist. Throws
  /// GraphError if the text is no graph.
  static Job from_text(std::string text, const std::filesystem::path& as = "graph.json");

  /// Sets a parameter of the graph, or "node.parameter", to a value. Paths are relative to the working folder. check()
  /// and checked() report invalid names and values.
  Job& set(const std::string& name, const ParamValue& value);
  /// The same for a value as spelled on the command line: "512x512", "[1, 2]", "=2 * seed", "@node".
  Job& set_text(const std::string& name, const std::string& value);
  /// Undoes set() and set_text() for this name.
  Job& unset(const std::string& name);
  /// Applies a preset of the graph. Values from set() take precedence.
  Job& preset(const std::string& name);
  /// Applies a settings file: a JSON object of values by name. Takes precedence over presets, but not over set().
  Job& settings(const std::filesystem::path& file);
  /// Feeds a value in memory into an input that the graph declares, or replaces a node that has a single output; that
  /// node then does not run. The value's digest is part of the cache keys, so results are reused for the same value.
  /// checked() throws Error if there is no such input or node, or if its type differs.
  Job& give(const std::string& name, Value value);

  /// The graph's parameters with their current values, in the document's order. Throws GraphError.
  std::vector<JobParameter> parameters() const;
  /// Parameters and nodes, for programs that list them. Never throws GraphError.
  JobOutline outline() const;
  /// The value set under this name, else the document's, as compact JSON; empty if there is neither.
  std::optional<std::string> value_of(const std::string& name) const;
  /// All problems that can be found without running; empty if the job can run. Never throws GraphError.
  std::vector<Problem> check() const;
  /// Valid but probably unintended settings; empty if there are problems.
  std::vector<Problem> warnings() const;
  /// The JSON pointer (RFC 6901) to the subject of a problem, also for values from set(); empty if it lies outside the
  /// document.
  std::string pointer_to(const Problem& problem) const;
  /// The graph, ready to run. With `only`, just the parameters that these nodes need must be set. Throws GraphError
  /// with all problems.
  CheckedJob checked(const std::vector<std::string>& only = {}) const;

  /// The document with the values from set() written into it; all other bytes, including comments, stay. Relative paths
  /// from set() start at the working folder and are rewritten to be relative to `folder`, where the text will be saved.
  /// Presets, settings files and values in memory are left out. Throws Error for values set inside a graph that is used
  /// as a node.
  std::string text(const std::filesystem::path& folder) const;
  /// The document's path, which need not exist.
  const std::filesystem::path& path() const { return path_; }

 private:
  Job() = default;
  std::string text_;
  std::filesystem::path path_;
  std::vector<std::pair<std::string, std::string>> values_;  ///< by name, as the command line spells them
  std::vector<std::string> presets_;
  std::vector<std::filesystem::path> settings_;
  std::vector<std::pair<std::string, Value>> given_;

  std::vector<Override> overrides() const;
};

}  // namespace terrazzo
