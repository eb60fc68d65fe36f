#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "graphs/text/graph.h"
#include "graphs/text/problem.h"

/// One graph, run with many values.
namespace terrazzo {

/// The values of one run, by the names that overrides have, as the command line would spell them.
struct Variation {
  /// Where a value is given.
  struct Origin {
    std::string where;   ///< `--sweep "seed=1..8"`, `column "seed"`
    std::string file{};  ///< of a table, with the place in it
    Place place{};
  };
  std::vector<std::pair<std::string, std::string>> values;
  std::map<std::string, Origin> origins{};  ///< by name

  std::string label() const;                   ///< "seed=3, size=512"
  std::vector<std::string> overrides() const;  ///< "seed=3", "size=512"
};

/// Of problems with a variation's values, tells where these are given; of one that looks like a range in other words,
/// how a range is written.
std::vector<Problem> with_origins(std::vector<Problem> problems, const Variation& variation);

/// At most this many: more are probably unintended.
inline constexpr size_t most_variations = 10000;

/// Every combination of the values of all sweeps, the last one changing fastest. A sweep is `name=1,2,4` (commas inside
/// brackets, braces or quotes do not separate), `name=1..64` or, with a step, `name=0..1:0.25`. Throws Error.
std::vector<Variation> swept(const std::vector<std::string>& sweeps);

/// The rows of a table: a CSV file (RFC 4180) whose first line names the values, or a JSON list of objects. A cell that
/// is empty, or a name that is missing, sets nothing. Throws Error with file and line.
std::vector<Variation> read_table(const std::filesystem::path& file);

/// Each of `rows` with each of `columns`; if one of them is empty, the other. Throws Error if both give a value.
std::vector<Variation> combined(const std::vector<Variation>& rows, const std::vector<Variation>& columns);

/// All variations as one graph, so that they are planned, checked and run together.
struct MergedGraph {
  Graph graph;
  std::vector<std::map<std::string, std::string>> names;  ///< by variation: what each of its nodes is called now
};

/// Makes it of one graph after the other, and keeps only what they do not share.
class GraphMerger {
 public:
  void add(Graph graph, const std::string& label);
  /// Adds the graph at this position once more.
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
  std::set<std::pair<std::string, std::string>> made_;          ///< names and signatures
  std::map<std::string, size_t> kinds_;                         ///< by name: how many there are
  std::vector<Node> nodes_;                                     ///< in the order of wires
};

/// Nodes that are the same in several variations (same type, parameters and inputs) are there once. Where variations
/// differ, a node's name has the variation's label behind it. `graphs` and `labels` are in the same order.
MergedGraph merged(const std::vector<Graph>& graphs, const std::vector<std::string>& labels);

}  // namespace terrazzo
