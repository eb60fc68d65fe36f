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

/// Which variations of a graph to run, and what to make of them.
struct SweepFlags {
  std::vector<std::string> sweeps;
  std::string table, sheet, figures, best;

  bool asked() const { return !sweeps.empty() || !table.empty(); }
};

/// --sweep and --table.
void add_variation_flags(Command& command, SweepFlags& flags);
/// The same, and what to make of the results.
void add_sweep_flags(Command& command, SweepFlags& flags);

/// Several variations of a graph, run as one: analyses and whatever else they share are made once.
class Sweep {
 public:
  /// Reads sweeps and table. Throws UsageError.
  explicit Sweep(const SweepFlags& flags);

  /// Loads every variation by `load`, which gets its overrides, into one graph; adds what contact sheet and figures
  /// need. Throws GraphError, and UsageError if the graph has nothing to show or to compare.
  Graph load(const std::function<Graph(const std::vector<std::string>&)>& load);

  /// The same for a graph and values of the command line; `warn` gets each warning once.
  Graph load(const GraphFlags& values, const LoadOptions& options, const std::function<void(const std::string&)>& warn);

  /// What these nodes are called in the merged graph, in every variation; and what has to run and to be kept besides.
  std::vector<std::string> names_of(const std::vector<std::string>& nodes) const;
  /// The nodes of the merged graph that only one variation has, and its label.
  std::map<std::string, std::string> of_one_variation() const;
  const std::vector<std::string>& targets() const { return targets_; }
  const std::vector<std::string>& kept() const { return kept_; }

  /// After a run: prints a table of all variations, with their figures; writes what was asked for; names the best.
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
  std::vector<std::string> comparisons_;  ///< by variation: the node that compares
  std::vector<std::string> targets_, kept_;
  bool higher_is_better_ = false;  ///< of the figure that decides
};

}  // namespace terrazzo
