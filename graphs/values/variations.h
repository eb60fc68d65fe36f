#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "graphs/text/graph.h"
#include "graphs/values/override.h"

/// Runs of one graph with many sets of values.
namespace terrazzo {

/// The values of one run, by override name, as spelled on the command line.
struct Variation {
  /// Where a value comes from.
  struct Origin {
    std::string where;   ///< `--sweep "seed=1..8"`, `column "seed"`
    std::string file{};  ///< a table's file, with the place in it
    Place place{};
  };
  std::vector<std::pair<std::string, std::string>> values;
  std::map<std::string, Origin> origins{};  ///< by name

  std::string label() const;  ///< "seed=3, size=512"
  /// Problems with them name the values' origins, with a hint on how to write ranges if a value looks like one.
  std::vector<Override> overrides() const;
};

/// The most variations; more are probably unintended.
inline constexpr size_t most_variations = 10000;

/// All combinations of the sweeps' values; the last sweep varies fastest. A sweep is `name=1,2,4` (commas inside
/// brackets, braces or quotes do not separate), `name=1..64` or, with a step, `name=0..1:0.25`. Throws Error.
std::vector<Variation> swept(const std::vector<std::string>& sweeps);

/// The rows of a table: a CSV file (RFC 4180) whose first line names the values, or a JSON list of objects. Empty cells
/// and missing names set nothing. Throws Error with file and line.
std::vector<Variation> read_table(const std::filesystem::path& file);

/// All combinations of `rows` and `columns`; if one is empty, the other. Throws Error if both set the same name.
std::vector<Variation> combined(const std::vector<Variation>& rows, const std::vector<Variation>& columns);

/// All variations merged into one graph, which is planned, checked and run as a whole.
struct MergedGraph {
  Graph graph;
  std::vector<std::map<std::string, std::string>> names;  ///< by variation: the new name of each of its nodes
};

/// Builds the merged graph incrementally and stores shared nodes once.
class GraphMerger {
 public:
  void add(Graph graph, const std::string& label);
  /// Adds the graph at index `same` again.
  void add_again(size_t same);
  MergedGraph merged();

 private:
  struct Node {
    GraphNode node;
    size_t first = 0;  ///< the variation it comes from
  };
  Graph merged_;
  std::vector<std::string> labels_;
  std::vector<std::map<std::string, std::string>> signatures_;  ///< by variation and node
  std::set<std::pair<std::string, std::string>> made_;          ///< names and signatures of added nodes
  std::map<std::string, size_t> kinds_;                         ///< number of different nodes by name
  std::vector<Node> nodes_;                                     ///< in the order of wires
};

/// Merges graphs. Equal nodes (same type, parameters and inputs) occur once. If variations differ, the variation's
/// label is appended to the node's name. `graphs` and `labels` are in the same order.
MergedGraph merged(const std::vector<Graph>& graphs, const std::vector<std::string>& labels);

}  // namespace terrazzo
