#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// The positions of nodes on an editor's canvas, in GRAPH.layout.json beside GRAPH.json:
///
///     {"levels": {"": {"nodes": {"exemplar": [40, 80], "weighted": {"at": [320, 80], "pinned": true}},
///                      "frames": {"f1": {"title": "analysis", "at": [20, 40], "size": [640, 300]}},
///                      "wires": {"exemplar.material > weighted.material": [[260, 20], [280, 140]]}}}}
///
/// Anything else in the file is kept.
namespace terrazzo {

struct NodePlace {
  double x = 0, y = 0;
  bool pinned = false;
  bool operator==(const NodePlace&) const = default;
};

struct LayoutFrame {
  std::string title;
  double x = 0, y = 0, width = 0, height = 0;
  bool operator==(const LayoutFrame&) const = default;
};

struct LevelLayout {
  std::map<std::string, NodePlace> nodes;
  std::map<std::string, LayoutFrame> frames;
  /// The points that a wire passes on its way from source to target, by "node.output > node.input".
  std::map<std::string, std::vector<std::array<double, 2>>> bends;
  bool operator==(const LevelLayout&) const = default;
};

/// The content of a sidecar file.
struct LayoutFile {
  std::map<std::string, LevelLayout> levels;  ///< by name of the graph; "" is the document's own
  std::string text;                           ///< of the file; empty if there is none
  std::string fault;                          ///< why it could not be read; it is replaced once something is moved

  bool operator==(const LayoutFile& other) const { return text == other.text && fault == other.fault; }
};

/// GRAPH.layout.json for GRAPH.json.
std::filesystem::path layout_path(const std::filesystem::path& graph);

/// Never throws because of `text`; see LayoutFile::fault.
LayoutFile read_layout(std::string text);

/// The layout with these levels: changes only what differs in the text.
LayoutFile with_levels(const LayoutFile& before, const std::map<std::string, LevelLayout>& levels);

}  // namespace terrazzo
