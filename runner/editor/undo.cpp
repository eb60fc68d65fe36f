#include "runner/editor/undo.h"

#include <algorithm>

namespace terrazzo {

namespace {

constexpr size_t most_steps = 10000;
constexpr std::chrono::seconds merging_time{1};

void replace(std::string& text, size_t begin, const std::string& old, const std::string& now) {
  text.replace(begin, old.size(), now);
}

}  // namespace

TextPatch patch_between(const std::string& before, const std::string& after) {
  const size_t most = std::min(before.size(), after.size());
  size_t begin = 0, end = 0;
  while (begin < most && before[begin] == after[begin]) begin++;
  while (end < most - begin && before[before.size() - 1 - end] == after[after.size() - 1 - end]) end++;
  return {begin, before.substr(begin, before.size() - end - begin), after.substr(begin, after.size() - end - begin)};
}

void UndoStack::add(const DocumentTexts& before, const DocumentTexts& after, const std::string& label, const Key& key,
                    Clock::time_point now) {
  steps_.resize(done_);
  DocumentTexts first = before;
  if (!key.text.empty() && !steps_.empty() && steps_.back().key == key &&
      (key.is_gesture || now - steps_.back().time < merging_time)) {
    undo(first);
    steps_.pop_back();
  }
  if (steps_.size() >= most_steps) steps_.erase(steps_.begin());
  steps_.push_back(
      {patch_between(first.graph, after.graph), patch_between(first.layout, after.layout), label, key, now});
  done_ = steps_.size();
}

bool UndoStack::undo(DocumentTexts& texts) {
  if (done_ == 0) return false;
  const Step& step = steps_[--done_];
  replace(texts.graph, step.graph.begin, step.graph.after, step.graph.before);
  replace(texts.layout, step.layout.begin, step.layout.after, step.layout.before);
  return true;
}

bool UndoStack::redo(DocumentTexts& texts) {
  if (done_ == steps_.size()) return false;
  const Step& step = steps_[done_++];
  replace(texts.graph, step.graph.begin, step.graph.before, step.graph.after);
  replace(texts.layout, step.layout.begin, step.layout.before, step.layout.after);
  return true;
}

std::optional<std::string> UndoStack::undo_label() const {
  return done_ > 0 ? std::optional(steps_[done_ - 1].label) : std::nullopt;
}

std::optional<std::string> UndoStack::redo_label() const {
  return done_ < steps_.size() ? std::optional(steps_[done_].label) : std::nullopt;
}

}  // namespace terrazzo
