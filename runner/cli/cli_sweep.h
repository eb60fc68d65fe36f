#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/node/report.h"
#include "graphs/values/variations.h"
#include "runner/cli/cli_graph.h"
#include "runner/engine/schedule.h"
#include "runner/terminal/command.h"

namespace terrazzo {

/// The variations of a graph to run, and the outputs to make from them.
struct SweepFlags {
  std::vector<std::string> sweeps;
  std::string table, sheet, figures, best;

  bool asked() const { return !sweeps.empty() || !table.empty(); }
};

/// --sweep and --table.
void add_variation_flags(Command& command, SweepFlags& flags);
/// The same, and the options for outputs.
void add_sweep_flags(Command& command, SweepFlags& flags);

/// Several variations of a graph, run as one graph: shared nodes, such as analyses, run once.
class Sweep {
 public:
  /// Reads sweeps and table. Throws UsageError.
  explicit Sweep(const SweepFlags& flags);

  /// Loads every variation by calling `load` with its overrides, and merges them into one graph. Adds the nodes for
  /// contact sheet and figures. Throws GraphError, and UsageError if the graph has nothing to show or to compare.
  Graph load(const std::function<Graph(const std::vector<Override>&)>& load);

  /// The same for a graph and values from the command line; calls `warn` once per warning.
  Graph load(const GraphFlags& values, const LoadOptions& options, const std::function<void(const std::string&)>& warn);

  /// The names of these nodes in the merged graph, for all variations, and further nodes that must run and be kept.
  std::vector<std::string> names_of(const std::vector<std::string>& nodes) const;
  /// The nodes of the merged graph that belong to only one variation, with its label.
  std::map<std::string, std::string> of_one_variation() const;
  const std::vector<std::string>& targets() const { return targets_; }
  const std::vector<std::string>& kept() const { return kept_; }

  /// After a run: prints a table of all variations with their figures, writes the requested files, and names the best
  /// variation.
  void report(const RunResult& result) const;

 private:
  using Nodes = std::map<std::string, const GraphNode*>;

  void check_paths(const Graph& first, const Nodes& nodes) const;
  std::string way_apart(const Graph& graph) const;
  std::vector<std::string> names_that_vary() const;
  template <typename T>
  std::vector<T> of_each(const std::string& base, const std::function<T(const std::string& node)>& make) const;
  void add_sheet(const Graph& document, const Nodes& nodes, std::vector<GraphNode>& added);
  void add_comparisons(const Graph& document, const Nodes& nodes, std::vector<GraphNode>& added);
  std::vector<std::string> labels() const;
  std::vector<const Report*> reports(const RunResult& result) const;
  void check_best(const Nodes& nodes, const std::vector<GraphNode>& added);
  void tell_best(const std::vector<const Report*>& reports) const;

  const SweepFlags& flags_;
  std::vector<Variation> variations_;
  std::vector<std::map<std::string, std::string>> names_;
  std::vector<Wire> pictures_;            ///< by variation; for the contact sheet
  std::vector<std::string> comparisons_;  ///< by variation: its compare node
  std::vector<std::string> targets_, kept_;
  bool higher_is_better_ = false;  ///< for the deciding figure
};

}  // namespace terrazzo
