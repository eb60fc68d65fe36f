#pragma once

#include <map>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "graphs/edit/edit_document.h"
#include "runner/editor/layout_file.h"

namespace terrazzo {

/// The positions of all nodes of all levels: those given, the others laid out automatically, from left to right.
std::map<std::string, LevelLayout> complete_layout(std::string_view text,
                                                   const std::map<std::string, LevelLayout>& levels);

/// Changes the positions of nodes along with a document. The first move in a level writes down all its positions, and
/// so does an edit after which others would be placed elsewhere: nodes stay where they are seen.
class LayoutEdits {
 public:
  LayoutEdits(const std::string& text, const LayoutFile& layout);

  /// After edits of the graph: nodes that were added, renamed, removed, grouped and ungrouped. `edits` are those that
  /// led to `changed`.
  void follow(const EditedText& changed, const nlohmann::ordered_json& edits);
  /// Applies move, pin, bend or frame. Throws Error.
  void apply(const nlohmann::ordered_json& edit);

  LayoutFile result() const;
  std::string label() const { return label_; }

 private:
  LevelLayout& frozen(const std::string& level);
  void keep_places(const JsonValue& before, const JsonValue& after, const nlohmann::ordered_json& edits);
  void follow_wires(const JsonValue& after, const EditedText& changed);
  void place_added(const EditedText& changed, const nlohmann::ordered_json& edits,
                   const std::map<size_t, NodePlace>& ungrouped);

  std::string text_;
  const LayoutFile& before_;
  std::map<std::string, LevelLayout> levels_;
  std::string label_;
};

}  // namespace terrazzo
