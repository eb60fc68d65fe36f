#include "runner/editor/document.h"

#include <mutex>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "core/file/atomic_file.h"
#include "core/file/file_io.h"
#include "graphs/edit/edit_document.h"
#include "graphs/edit/merge.h"
#include "graphs/text/edit.h"
#include "graphs/text/format.h"
#include "graphs/text/read_document.h"
#include "runner/editor/layout_edits.h"
#include "runner/editor/recent_texts.h"
#include "runner/editor/undo.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

using EditRequest = nlohmann::ordered_json;

constexpr const char* empty_graph = "{\n  \"terrazzo\": 1,\n  \"nodes\": {}\n}\n";

/// Nullopt if there is no such file.
std::optional<std::string> content_of(const fs::path& path) {
  try {
    return read_file(path, uint64_t{64} << 20);
  } catch (const FileError& e) {
    if (e.code() == ENOENT || e.code() == ENOTDIR) return std::nullopt;
    throw;
  }
}

/// Renaming would replace a file that nobody may write to.
void refuse_write_protected(const fs::path& path) {
  struct stat facts {};
  if (::stat(path.c_str(), &facts) == 0 && (facts.st_mode & 0222) == 0)
    throw FileError(fmt::format("{} is write-protected", path.string()), EACCES);
}

std::string text_in(const EditRequest& object, const char* key) {
  const auto at = object.find(key);
  return at != object.end() && at->is_string() ? at->get<std::string>() : "";
}

bool is_op(const EditRequest& edit, std::initializer_list<const char*> ops) {
  const std::string op = edit.is_object() ? text_in(edit, "op") : "";
  return std::ranges::any_of(ops, [&](const char* o) { return op == o; });
}

/// The text that an edit "text" comes to: merged with what has changed since `was`, the text that it was made from.
std::string edited_text(const EditRequest& edits, const EditRequest& request, const std::string& now,
                        int64_t revision) {
  if (edits.size() > 1) throw EditRefused("the whole text is an edit by itself");
  if (!edits[0].contains("text") || !edits[0]["text"].is_string()) throw EditRefused("expected the text");
  std::string text = text_in(edits[0], "text");
  if (edits[0].contains("was")) {
    const std::string was = text_in(edits[0], "was");
    if (was == now || text == now) return text;
    MergedText merge = merged(was, text, now);
    if (merge.conflict.empty()) return std::move(merge.text);
    throw EditRefused("the document was changed elsewhere meanwhile: " + merge.conflict);
  }
  const auto base = request.find("base");
  if (base != request.end() && base->is_number_integer() && base->get<int64_t>() != revision)
    throw EditRefused("the document has changed since this text was read; look at it again");
  return text;
}

/// A text with a slip must not take the graph away unseen; `broken` in the edit says that it is meant.
void refuse_slip(const EditRequest& edit, const std::string& before, const std::string& after) {
  const auto meant = edit.find("broken");
  if ((meant != edit.end() && *meant == true) || before == after || !parse_json(before).value) return;
  const ParsedJson parsed = parse_json(after);
  if (parsed.value) return;
  const Problem& p = parsed.problems.back();
  throw EditRefused(fmt::format("line {}, column {}: {}", p.place.line, p.place.column, p.message));
}

UndoStack::Key merging_key(const EditRequest& request, const EditRequest& edits) {
  const std::string tab = text_in(request, "tab") + '\n';
  if (const std::string gesture = text_in(request, "gesture"); !gesture.empty()) return {tab + gesture, true};
  if (text_in(request, "label").empty() || edits.size() != 1 || !is_op(edits[0], {"set", "value"})) return {};
  std::string out = tab;
  for (const char* key : {"op", "level", "node", "key", "name"}) out += text_in(edits[0], key) + '\n';
  return {out};
}

}  // namespace

class EditedDocument::Data {
 public:
  mutable std::mutex mutex;
  fs::path file, layout_file;
  bool read_only = false;
  DocumentTexts now, disk;  ///< in memory; as last read from disk or written to it
  bool exists = false;      ///< the graph file, when last looked at
  LayoutFile layout;
  UndoStack steps;
  RecentTexts recent;
  int64_t revision = 1;
  OnDisk on_disk = OnDisk::same;
  std::string save_error, conflict, theirs;
  std::optional<std::string> unsettled_graph, unsettled_layout;  ///< on disk, unreadable, and maybe half written

  void open(const fs::path& path, const std::optional<std::string>& begin) {
    file = fs::absolute(path).lexically_normal();
    layout_file = layout_path(file);
    const bool is_there = fs::exists(file);
    if (is_there) disk.graph = read_document(file);
    exists = is_there;
    now.graph = is_there ? disk.graph : begin.value_or(empty_graph);
    try {
      now.layout = disk.layout = content_of(layout_file).value_or("");
      layout = read_layout(now.layout);
    } catch (const FileError& e) {
      layout.fault = e.what();
    }
    recent.add(revision, now.graph);
  }

  void refuse_if_read_only() const {
    if (read_only) throw EditRefused("this editor shows the graph and does not change it");
  }

  /// One more step.
  void commit(DocumentTexts after, const std::string& label, const UndoStack::Key& key = {}) {
    if (after == now) return;
    steps.add(now, after, label, key);
    take(std::move(after));
    save();
  }

  void take(DocumentTexts after) {
    if (after.layout != now.layout) layout = read_layout(after.layout);
    now = std::move(after);
    revision++;
    recent.add(revision, now.graph);
  }

  void refuse_unseen(const EditRequest& request, const EditRequest& edits) const {
    const auto base = request.find("base");
    if (base == request.end() || !base->is_number_integer()) return;
    const std::string pointer = recent.changed_since(base->get<int64_t>(), now.graph, edits);
    if (!pointer.empty()) throw EditConflict(pointer, "it was changed elsewhere at the same time: " + pointer);
  }

  /// Takes over what has changed on disk. `again`: some time has passed since the last call with it.
  void follow_disk(bool again) {
    try {
      if (const auto text = content_of(file); !is_half_written(text, disk.graph, unsettled_graph, again))
        follow_graph(text);
      if (const auto text = content_of(layout_file);
          !is_half_written(text, disk.layout, unsettled_layout, again) && text.value_or("") != disk.layout)
        follow_layout(text.value_or(""));
    } catch (const FileError& e) {
      set_error(e.what());
    }
  }

  void save() {
    if (read_only) return;
    follow_disk(false);
    if (on_disk != OnDisk::same || unsettled_graph || unsettled_layout) return;
    try {
      if (now.graph != disk.graph || !exists) {
        refuse_write_protected(file);
        write_whole_file(file, now.graph);
        disk.graph = now.graph;
        exists = true;
      }
      save_layout();
      set_error("");
    } catch (const FileError& e) {
      set_error(e.what());
    }
  }

  bool is_saved() const { return exists && now == disk; }

 private:
  void set_error(const std::string& message) {
    if (message != save_error) revision++;
    save_error = message;
  }

  void set_on_disk(OnDisk state, const std::string& why) {
    if (state != on_disk || why != conflict) revision++;
    on_disk = state;
    conflict = why;
  }

  void follow_graph(const std::optional<std::string>& text) {
    if (!text) {
      if (exists) set_on_disk(OnDisk::gone, "the file has been removed or renamed");
      return;
    }
    exists = true;
    if (*text == disk.graph || *text == now.graph) {
      disk.graph = *text;
      set_on_disk(OnDisk::same, "");
      return;
    }
    const MergedText merge = merged(disk.graph, now.graph, *text);
    if (!merge.conflict.empty()) {
      theirs = *text;
      set_on_disk(OnDisk::changed, merge.conflict);
      return;
    }
    steps.add(now, {merge.text, now.layout}, "the change on disk", {});
    take({merge.text, now.layout});
    disk.graph = *text;
    set_on_disk(OnDisk::same, "");
  }

  /// Another program may be writing a file: a text that cannot be read counts once it is the same at the next look.
  static bool is_half_written(const std::optional<std::string>& text, const std::string& known,
                              std::optional<std::string>& unsettled, bool again) {
    const bool waits = text && *text != known && !parse_json(*text).value && !(again && unsettled == text);
    unsettled = waits ? text : std::nullopt;
    return waits;
  }

  /// Of two changes of the same position that in memory counts.
  void follow_layout(const std::string& text) {
    const MergedText merge = merged(disk.layout, now.layout, text);
    disk.layout = text;
    if (merge.conflict.empty() && merge.text != now.layout) take({now.graph, merge.text});
  }

  void save_layout() {
    if (now.layout == disk.layout) return;
    if (now.layout.empty()) {
      std::error_code ignored;
      fs::remove(layout_file, ignored);
    } else {
      refuse_write_protected(layout_file);
      write_whole_file(layout_file, now.layout);
    }
    disk.layout = now.layout;
  }
};

EditedDocument::EditedDocument(const fs::path& file, bool read_only) : data_(std::make_unique<Data>()) {
  data_->read_only = read_only;
  data_->open(file, std::nullopt);
}

EditedDocument::EditedDocument(const fs::path& file, std::string text) : data_(std::make_unique<Data>()) {
  data_->open(file, std::move(text));
}

EditedDocument::~EditedDocument() = default;

DocumentSnapshot EditedDocument::snapshot() const {
  const std::lock_guard lock(data_->mutex);
  const Data& d = *data_;
  return {.revision = d.revision,
          .file = d.file,
          .text = d.now.graph,
          .layout = d.layout,
          .undo = d.steps.undo_label(),
          .redo = d.steps.redo_label(),
          .saved = d.is_saved(),
          .exists = d.exists,
          .read_only = d.read_only,
          .on_disk = d.on_disk,
          .save_error = d.save_error,
          .conflict = d.conflict};
}

int64_t EditedDocument::revision() const {
  const std::lock_guard lock(data_->mutex);
  return data_->revision;
}

EditAnswer EditedDocument::edit(const EditRequest& request) {
  const std::lock_guard lock(data_->mutex);
  Data& d = *data_;
  d.refuse_if_read_only();
  const auto given = request.is_object() ? request.find("edits") : request.end();
  if (!request.is_object() || given == request.end() || !given->is_array() || given->empty())
    throw EditRefused("expected {\"base\": revision, \"edits\": [...]}");
  const EditRequest& edits = *given;
  EditAnswer answer;
  std::string label = text_in(request, "label");
  DocumentTexts after = d.now;
  if (is_op(edits[0], {"text"})) {
    after.graph = edited_text(edits, request, d.now.graph, d.revision);
    refuse_slip(edits[0], d.now.graph, after.graph);
    if (label.empty()) label = "edit the text";
  } else {
    try {
      LayoutEdits layout(d.now.graph, d.layout);
      EditRequest of_graph = EditRequest::array();
      std::vector<const EditRequest*> of_layout;
      for (const EditRequest& e : edits)
        if (is_op(e, {"move", "pin", "frame", "bend"}))
          of_layout.push_back(&e);
        else
          of_graph.push_back(e);
      EditedText changed{.text = d.now.graph};
      if (!of_graph.empty()) changed = edited(d.now.graph, d.file, json_in(of_graph.dump()));
      layout.follow(changed, of_graph);
      for (const EditRequest* e : of_layout) layout.apply(*e);
      after.graph = changed.text;
      after.layout = layout.result().text;
      if (label.empty()) label = changed.label.empty() ? layout.label() : changed.label;
      answer.names = changed.added;
      answer.taken = changed.taken;
    } catch (const Error& e) {
      throw EditRefused(e.about(), e.what());
    } catch (const EditRequest::exception& e) {
      throw EditRefused(fmt::format("the request is malformed: {}", e.what()));
    }
  }
  if (after != d.now) d.refuse_unseen(request, edits);
  d.commit(std::move(after), label, merging_key(request, edits));
  answer.revision = d.revision;
  return answer;
}

EditAnswer EditedDocument::undo() {
  const std::lock_guard lock(data_->mutex);
  data_->refuse_if_read_only();
  DocumentTexts texts = data_->now;
  if (data_->steps.undo(texts)) {
    data_->take(std::move(texts));
    data_->save();
  }
  return {.revision = data_->revision};
}

EditAnswer EditedDocument::redo() {
  const std::lock_guard lock(data_->mutex);
  data_->refuse_if_read_only();
  DocumentTexts texts = data_->now;
  if (data_->steps.redo(texts)) {
    data_->take(std::move(texts));
    data_->save();
  }
  return {.revision = data_->revision};
}

EditAnswer EditedDocument::format() {
  const std::lock_guard lock(data_->mutex);
  data_->refuse_if_read_only();
  try {
    data_->commit({formatted(json_in(data_->now.graph)), data_->now.layout}, "format");
  } catch (const Error& e) {
    throw EditRefused(e.what());
  }
  return {.revision = data_->revision};
}

EditAnswer EditedDocument::resolve(bool keep_mine) {
  const std::lock_guard lock(data_->mutex);
  Data& d = *data_;
  d.refuse_if_read_only();
  if (d.on_disk == OnDisk::same) return {.revision = d.revision};
  if (d.on_disk == OnDisk::gone && !keep_mine) throw EditRefused("the file is gone; there is nothing to take from it");
  if (d.on_disk == OnDisk::gone) d.exists = false;
  const bool was_changed = d.on_disk == OnDisk::changed;
  d.on_disk = OnDisk::same;
  d.conflict.clear();
  d.revision++;
  if (was_changed) d.disk.graph = d.theirs;
  if (keep_mine)
    d.save();
  else
    d.commit({d.theirs, d.now.layout}, "take the file on disk");
  return {.revision = d.revision};
}

std::string EditedDocument::copy(const std::string& level, const std::vector<std::string>& nodes) const {
  const std::lock_guard lock(data_->mutex);
  try {
    return copied_nodes(data_->now.graph, level, nodes);
  } catch (const Error& e) {
    throw EditRefused(e.about(), e.what());
  }
}

bool EditedDocument::look_at_disk() {
  const std::lock_guard lock(data_->mutex);
  const int64_t before = data_->revision;
  data_->follow_disk(true);
  const bool begun = data_->exists || !data_->save_error.empty();
  if (begun && data_->on_disk == OnDisk::same && !data_->is_saved()) data_->save();
  return data_->revision != before;
}

}  // namespace terrazzo
