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

/// Changes the positions of nodes along with a document. The first move in a level writes down all its positions, so
/// that the others stay where they are seen.
class LayoutEdits {
 public:
  LayoutEdits(const std::string& text, const LayoutFile& layout);

  /// After edits of the graph: nodes that were added, renamed, removed, grouped and ungrouped. `edits` are those that
  /// led to `changed`.
  void follow(const EditedText& changed, const nlohmann::ordered_json& edits);
  /// Applies move, pin or frame. Throws Error.
  void apply(const nlohmann::ordered_json& edit);

  LayoutFile result() const;
  std::string label() const { return label_; }

 private:
  LevelLayout& frozen(const std::string& level);
  void place_added(const EditedText& changed, const nlohmann::ordered_json& edits);

  std::string text_;
  const LayoutFile& before_;
  std::map<std::string, LevelLayout> levels_;
  std::string label_;
};

}  // namespace terrazzo
