#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "graphs/document/forecasts.h"
#include "graphs/document/levels.h"
#include "graphs/document/wires.h"

namespace terrazzo {

/// The second pass over a document: reads the values that query results of nodes, which it forecasts. The first pass,
/// Levels::read, has read all other values.
class ForecastPass {
 public:
  ForecastPass(Levels& levels, std::vector<Problem>& problems) : levels_(levels), problems_(problems) {}

  /// Replaces the names in queries by those of the nodes behind them, through inputs and subgraphs. Call it when all
  /// nodes are connected.
  void resolve_queries();
  /// Reads the values node by node, so that each can query earlier nodes. `order` is topological.
  void run(const std::vector<size_t>& order, Level& root);
  /// What the hooks of queried nodes refuse. Some of these nodes may not be needed.
  std::vector<Problem>& problems_of_sources() { return of_sources_; }

 private:
  WireSources sources_behind(const std::string& asked) const;
  std::string node_behind(const std::string& asked) const;
  void resolve_queries_of(NodeDraft& draft) const;
  void set_forecasts(const GraphScope::Forecasts& forecasts);
  bool are_sources_complete(NodeDraft& draft) const;
  void read_waiting_in(NodeDraft& draft);
  void read_uses(Level& level);
  bool look_ahead(const NodeDraft& draft);
  void evaluate_rest(Level& root);

  Levels& levels_;
  std::vector<Problem>& problems_;
  std::vector<Problem> of_sources_;
  Forecasts forecasts_;
  std::map<std::string, const NodeDraft*> by_name_;
  std::set<std::string> known_;
  std::set<std::string> incomplete_;  ///< their problems and unset values are reported elsewhere
};

}  // namespace terrazzo
