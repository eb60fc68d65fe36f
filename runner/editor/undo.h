#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace terrazzo {

/// What an edited document consists of on disk.
struct DocumentTexts {
  std::string graph, layout;
  bool operator==(const DocumentTexts&) const = default;
};

/// The difference of two texts: one replaced part.
struct TextPatch {
  size_t begin = 0;
  std::string before, after;
};
TextPatch patch_between(const std::string& before, const std::string& after);

/// The steps that can be undone and done again. Restores texts to the byte. Not thread-safe.
class UndoStack {
 public:
  using Clock = std::chrono::steady_clock;

  /// Steps with the same key, not empty, within a second of each other become one. So do those of one gesture, such as
  /// a drag, however long it takes.
  struct Key {
    std::string text{};
    bool is_gesture = false;
    bool operator==(const Key&) const = default;
  };
  void add(const DocumentTexts& before, const DocumentTexts& after, const std::string& label, const Key& key,
           Clock::time_point now = Clock::now());
  /// Changes the texts; false if there is no step.
  bool undo(DocumentTexts& texts);
  bool redo(DocumentTexts& texts);
  std::optional<std::string> undo_label() const;
  std::optional<std::string> redo_label() const;

 private:
  struct Step {
    TextPatch graph, layout;
    std::string label;
    Key key;
    Clock::time_point time;
  };
  std::vector<Step> steps_;
  size_t done_ = 0;  ///< steps before this one can be undone, the others done again
};

}  // namespace terrazzo
