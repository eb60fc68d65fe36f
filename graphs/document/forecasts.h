#pragma once

#include <map>
#include <string>

#include "graphs/text/graph.h"

namespace terrazzo {

/// What is known of nodes' results before anything runs, according to their types' infer and preflight.
class Forecasts {
 public:
  /// Adds a checked node; its sources must come first. Null if its type has neither hook. Throws what the hooks throw:
  /// Error or Errors.
  const Forecast* add(const GraphNode& node);
  /// Null if nothing is known.
  const Forecast* find(const std::string& node) const;
  /// The same for one output.
  const Forecast* find_output(const Wire& output) const;
  /// The forecasts of a node's inputs; empty forecasts where nothing is known.
  InputForecasts inputs_of(const GraphNode& node) const;

 private:
  std::map<std::string, Forecast> nodes_;
  struct Output {
    ValueType type;
    Forecast forecast;
  };
  std::map<Wire, Output> outputs_;
};

}  // namespace terrazzo
