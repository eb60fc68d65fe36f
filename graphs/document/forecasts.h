#pragma once

#include <map>
#include <string>

#include "graphs/text/graph.h"

namespace terrazzo {

/// What is known of the results of nodes before anything runs, as the rules and preflights of their types say.
class Forecasts {
 public:
  /// Looks ahead at a checked node, after all that it reads. Null if its type cannot tell. Throws what these
  /// throw: Error, or Errors.
  const Forecast* add(const GraphNode& node);
  /// Null if nothing is known.
  const Forecast* find(const std::string& node) const;
  /// The same of one output.
  const Forecast* find_output(const Wire& output) const;
  /// What is known of all that comes into a node; empty forecasts where nothing is.
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
