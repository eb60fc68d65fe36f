#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/base/error.h"
#include "runner/editor/layout_file.h"

/// A graph file that is being edited: its text, the positions of its nodes, undo, and the files on disk.
namespace terrazzo {

/// Why an edit was refused, for the user; nothing has changed then. about() is the JSON pointer of the part concerned.
class EditRefused : public Error {
 public:
  using Error::Error;
};

/// Another edit has changed the same value, which this one did not know of yet.
class EditConflict : public EditRefused {
 public:
  using EditRefused::EditRefused;
};

/// How the file on disk compares with what was last read from it or written to it.
enum class OnDisk : uint8_t { same, changed, gone };

/// The state of an EditedDocument at one time.
struct DocumentSnapshot {
  int64_t revision = 0;
  std::filesystem::path file;  ///< absolute
  std::string text;
  LayoutFile layout;
  std::optional<std::string> undo, redo;  ///< labels of the steps
  bool saved = true;
  bool exists = true;  ///< a new graph's file is written by the first edit
  bool read_only = false;
  OnDisk on_disk = OnDisk::same;
  std::string save_error;  ///< why the last attempt to save failed; the text is kept and saved later
  std::string conflict;    ///< if both changed the same thing: what, as a sentence
};

/// What a call changed.
struct EditAnswer {
  int64_t revision = 0;
  std::vector<std::string> names{};  ///< nodes that were added
  std::vector<std::string> taken{};  ///< what went away with the removed, a sentence each
};

/// Edits are applied as a whole or not at all, and saved at once. All functions are thread-safe; none is called back.
/// The clients of one document share it. Edits read the graph files that the document uses as types; a ReadGuard around
/// the call confines that. Relative positions and sizes of the layout are in pixels of the canvas.
class EditedDocument {
 public:
  /// Opens the file, which need not exist, need not be JSON and may be full of mistakes; a missing one begins as an
  /// empty graph and is created by the first edit. Throws GraphError if it cannot be read. A read-only document refuses
  /// edits. Writes nothing.
  explicit EditedDocument(const std::filesystem::path& file, bool read_only = false);
  /// If there is no such file, begins with this text, such as what `new` would write; the first edit creates the file.
  EditedDocument(const std::filesystem::path& file, std::string text);
  ~EditedDocument();
  EditedDocument(const EditedDocument&) = delete;
  EditedDocument& operator=(const EditedDocument&) = delete;

  DocumentSnapshot snapshot() const;
  /// Cheap: for asking whether something has changed.
  int64_t revision() const;

  /// Applies the request {"base": revision, "label"?, "tab"?, "gesture"?, "edits": [...]} as one step of undo: edits of
  /// graphs/edit, and those of the layout (move, pin, frame, bend) and of the whole text (text). Edits name nodes, so
  /// they apply to a newer revision than `base`, too; only "text" needs the same, or `was`, the text that it was made
  /// from: then it is merged with what has changed since. With a label, sets of the same key by the same tab within a
  /// second become one step, and so do all edits of the same gesture. Throws EditRefused; EditConflict if a value is
  /// replaced that has changed since `base`.
  EditAnswer edit(const nlohmann::ordered_json& request);
  /// Does nothing if there is no step. Throws EditRefused if the document is read-only.
  EditAnswer undo();
  EditAnswer redo();
  /// Writes the canonical layout. Throws EditRefused if the text is not JSON.
  EditAnswer format();
  /// After a conflict on disk: keeps the text in memory, or takes that of the disk (which can be undone).
  EditAnswer resolve(bool keep_mine);
  /// These nodes as text for the clipboard. Throws EditRefused.
  std::string copy(const std::string& level, const std::vector<std::string>& nodes) const;

  /// Looks whether the files have changed on disk, and tries again to save what could not be saved. To be called about
  /// twice a second. A change on disk that touches other parts than unsaved edits is merged; one of the same part is a
  /// conflict, which waits for `resolve`. Returns whether the snapshot has changed.
  bool look_at_disk();

 private:
  class Data;
  std::unique_ptr<Data> data_;
};

}  // namespace terrazzo
