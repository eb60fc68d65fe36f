#pragma once

#include <map>
#include <string>
#include <vector>

#include "graphs/text/json.h"
#include "runner/editor/layout_file.h"

namespace terrazzo {

/// Chooses positions for the nodes of a level. The cards are as large as the page draws them.
class Arrangement {
 public:
  using Positions = std::map<std::string, NodePlace>;

  /// `nodes`: of the document or of one of its graphs. Their order, and that of their wires, decides.
  Arrangement(const JsonValue& document, const JsonValue& nodes);

  /// All of them, from left to right; what would be a long line goes on in rows below. In pixels; the top left corner
  /// of the whole is near 0, 0.
  Positions automatic() const;
  /// Those of `known`, and the others beside what they read, where nothing stands.
  Positions completed(Positions known) const;
  /// The nearest place at or below `wanted` where the card of this node covers none of `others`.
  NodePlace free_place(NodePlace wanted, const std::string& node, const Positions& others) const {
    return free_place(wanted, positions_.at(node), others);
  }

  /// The nodes of a block, all moved down as far as none of them covers one of `others`.
  Positions clear_of(Positions block, const Positions& others) const;

 private:
  /// How far down the bottom of something is that the node would cover there; 0 if it covers nothing.
  double way_down(const NodePlace& place, size_t node, const Positions& others) const;
  NodePlace free_place(NodePlace place, size_t node, const Positions& known) const;
  void sort();

  std::vector<std::string> names_;
  std::map<std::string, size_t> positions_;  ///< in names_
  std::vector<std::vector<size_t>> sources_;
  std::vector<double> heights_;
  std::vector<size_t> order_;  ///< sources before what reads them, as far as the wires form no cycle
};

}  // namespace terrazzo
