#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "graphs/text/graph.h"

namespace terrazzo {

/// A node of a document: of its own nodes (level ""), or of an entry of its section `graphs`.
struct NodeOfDocument {
  std::string level, node;
  auto operator<=>(const NodeOfDocument&) const = default;
};

/// How a node is to be shown.
struct Wish {
  NodeOfDocument at;
  bool is_looked_at = false;  ///< else only pinned: a small picture
  std::string map{};          ///< which map is wanted in full; empty: all
  int side = 0;               ///< the longest side of pictures, in pixels
  bool exact = false;         ///< every pixel, without loss
  bool operator==(const Wish&) const = default;
};

/// What the tabs of the browser want to see. Not thread-safe.
class Wishes {
 public:
  /// Reads the request {tab, pinned, looked?, side, full?}. Throws Error if it is wrong.
  void set(const nlohmann::ordered_json& request);
  /// Whether anything was wanted.
  bool forget(const std::string& tab);
  /// One per node, what is looked at first.
  std::vector<Wish> all() const;

 private:
  std::map<std::string, std::vector<Wish>> by_tab_;
};

/// The node of the loaded graph whose outputs show what a node of the document gives. `document`: its text. For a graph
/// used as a node, the node inside that others read; of several uses or iterations, the first.
std::optional<std::string> graph_node_of(const Graph& graph, const std::string& document, const NodeOfDocument& at);

/// Covers all that a node's result depends on, except for the content of files.
Digest recipe_of(const Graph& graph, const std::string& node);

}  // namespace terrazzo
