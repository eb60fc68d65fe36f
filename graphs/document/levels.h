#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "graphs/document/level.h"

/// The first pass over a document: reads the nodes of a graph and its subgraphs, except values that query results of
/// nodes.
namespace terrazzo {

/// An override of "walls[brick]/layout" in the level of the node "walls", on its way down.
struct RoutedOverride {
  const Override* override = nullptr;
  std::string name;   ///< "walls[brick]"
  std::string plain;  ///< "walls"
  std::string rest;   ///< "layout"
};

/// Reads levels and owns the result. Not thread-safe.
class Levels {
 public:
  Levels(Subgraphs& graphs, const KnownTypes& types, std::vector<Problem>& problems)
      : graphs_(graphs), types_(types), problems_(problems) {}

  /// Reads the document's nodes and those of its subgraphs. `root` has graph, parameters, scope and substitution.
  /// Overrides must outlive this.
  Level& read(std::unique_ptr<Level> root, const std::vector<Override>& overrides);

  /// The nodes that run: neither muted nor graphs.
  Drafts& nodes() { return nodes_; }
  /// The nodes that are graphs or muted.
  Drafts& others() { return others_; }
  const Drafts& nodes() const { return nodes_; }
  const Drafts& others() const { return others_; }
  const std::vector<std::unique_ptr<Level>>& all() const { return levels_; }
  /// The level with this path (the prefix of its nodes' names); null if there is none.
  const Level* find(const std::string& path) const {
    const auto at = by_path_.find(path);
    return at == by_path_.end() ? nullptr : at->second;
  }
  /// Whether a size limit was reached. The rest is then unread, and a problem has been reported.
  bool is_full() const { return is_full_; }
  /// Files and folders that loops depend on.
  const std::vector<LoopSource>& made_from() const { return made_from_; }
  /// Parameters without a value that loops need.
  const std::set<std::string>& unset_for_loops() const { return unset_for_loops_; }

 private:
  void read_level(Level& level, const std::vector<RoutedOverride>& overrides);
  void read_item(Level& level, const JsonMember& member, const std::vector<RoutedOverride>& overrides);
  void read_iteration(Level& level, const JsonMember& member, const std::string& local, NodeScope& names,
                      const std::vector<RoutedOverride>& overrides, std::vector<NodeInstance>& items);
  Level* read_use(Level& outer, NodeDraft& use, const Subgraph& graph, const std::vector<RoutedOverride>& overrides);
  void read_outputs(Level& level);
  std::optional<int64_t> read_seed(Level& level);
  NodeScope* names_of_iteration(Level& level, const LoopIteration& iteration, Diagnostics& diagnostics);
  void refuse_unknown(const Level& level, const std::vector<RoutedOverride>& overrides);

  Subgraphs& graphs_;
  const KnownTypes& types_;
  std::vector<Problem>& problems_;
  std::vector<std::unique_ptr<Level>> levels_;
  std::map<std::string, const Level*> by_path_;
  Drafts nodes_, others_;
  std::deque<NodeType> use_types_;
  std::deque<Port> output_ports_;
  std::vector<LoopSource> made_from_;
  std::set<std::string> unset_for_loops_;
  size_t text_ = 0;        ///< bytes in the nodes' values
  size_t parameters_ = 0;  ///< of subgraphs
  bool is_full_ = false;
};

/// Sets the parameters of a level from its node's values, as far as they are known.
void bind_parameters(Level& level);

}  // namespace terrazzo
