#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "runner/engine/schedule.h"
#include "tests/run_node.h"
#include "tests/texts.h"

/// Small node types and graphs made in memory, for tests of the runner. Values are images of one pixel.
namespace terrazzo::test {

ImagePtr number_image(double value);
double number_of(const Value& value);

/// Node types: every one has one output "out" of type image, if it is not a sink.
struct FakeTypes {
  NodeType number;      ///< parameter `value`; persisted as payload
  NodeType quick;       ///< the same, persisted as digest
  NodeType sum;         ///< the sum of list input "in" plus parameter `plus`; payload
  NodeType quick_sum;   ///< the same, digest
  NodeType lazy_sum;    ///< the same, derived
  NodeType tens;        ///< "in" divided by ten and rounded down
  NodeType file;        ///< a number read from the file `path`; digest
  NodeType write;       ///< sink: writes the numbers of "in" to the file `path`
  NodeType fail;        ///< sum that throws an Error about its input
  NodeType write_fail;  ///< sink that stages a file, writes half of it, and throws
  NodeType endless;     ///< sink that stages a file and works until it is cancelled
  FakeTypes();
  FakeTypes(const FakeTypes&) = delete;
  FakeTypes& operator=(const FakeTypes&) = delete;

  /// How often nodes of a type have computed, by type name.
  int runs(const std::string& type) const { return counts_.at(type).load(); }
  /// Called by every `sum` node with its result, if set.
  std::function<void(NodeContext&)> during_sum;

 private:
  std::map<std::string, std::atomic<int>> counts_;
};

/// Wires are written "node" (output "out").
Graph& add(Graph& graph, const std::string& name, const NodeType& type, const Params& params = {},
           const std::vector<std::string>& in = {});
/// Sets a parameter of a node.
void set(Graph& graph, const std::string& node, const std::string& param, const ParamValue& value);

/// Two numbers "a" and "b" and their sum "total", which is 5.
Graph small_graph(const FakeTypes& types);

/// Options to run just these nodes and what they need, and keep what they give.
RunOptions keeping(const std::vector<std::string>& nodes, Cache* cache = nullptr);
/// What a node gave that was kept.
double kept_number(const RunResult& result, const std::string& node);

/// "reused", "run", ... of a node.
std::string outcome(const RunResult& result, const std::string& node);
/// "cached", "run", ... of a node in a plan, and its reason.
std::string state(const Plan& plan, const std::string& node);
std::string reason(const Plan& plan, const std::string& node);

}  // namespace terrazzo::test
