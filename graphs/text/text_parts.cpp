#include "graphs/text/text_parts.h"

#include <algorithm>

namespace terrazzo {

namespace {

/// Walks over a text that is known to be JSON.
class PartScanner {
 public:
  explicit PartScanner(std::string_view text) : text_(text), at_(text.starts_with("\xef\xbb\xbf") ? 3 : 0) {}

  TextPart document(const JsonValue& json) {
    skip_space();
    return value(json);
  }

 private:
  void skip_space() {
    while (at_ < text_.size()) {
      if (text_.substr(at_, 2) == "//")
        at_ = std::min(text_.find('\n', at_), text_.size());
      else if (std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos)
        at_++;
      else
        break;
    }
  }

  void skip_text() {
    for (at_++; text_[at_] != '"'; at_++)
      if (text_[at_] == '\\') at_++;
    at_++;
  }

  /// The end of the line from here, without the line break; here if something else is on the line.
  size_t rest_of_line() const {
    const size_t end = text_.find('\n', at_);
    if (end == text_.npos) return at_;
    const size_t next = std::min(text_.find_first_not_of(" \t\r", at_), end);
    if (next < end && text_.substr(next, 2) != "//") return at_;
    return text_[end - 1] == '\r' && end > at_ ? end - 1 : end;
  }

  TextPart value(const JsonValue& json) {
    TextPart out{.json = &json, .begin = at_, .entries = {}};
    if (json.is_object() || json.is_list()) {
      container(json, out);
    } else if (json.is_text()) {
      skip_text();
    } else {
      at_ = std::min(text_.find_first_of(",]}/ \t\r\n", at_), text_.size());
    }
    out.end = at_;
    return out;
  }

  void container(const JsonValue& json, TextPart& out) {
    at_++;
    out.head_end = at_ = rest_of_line();
    const size_t count = json.is_object() ? json.members.size() : json.items.size();
    out.entries.reserve(count);
    for (size_t i = 0; i < count; i++) {
      TextEntry entry{.lead = at_, .value = {}};
      skip_space();
      entry.name = entry.name_end = at_;
      if (json.is_object()) {
        skip_text();
        entry.name_end = at_;
        skip_space();
        at_++;
        skip_space();
      }
      entry.value = value(json.is_object() ? json.members[i].value : json.items[i]);
      entry.comma = at_;
      const size_t end = at_;
      skip_space();
      entry.has_comma = text_[at_] == ',';
      if (entry.has_comma) {
        entry.comma = at_;
        at_++;
      } else {
        at_ = end;
      }
      entry.tail = at_;
      entry.tail_end = at_ = rest_of_line();
      out.entries.push_back(std::move(entry));
    }
    out.close_lead = at_;
    skip_space();
    at_++;
  }

  std::string_view text_;
  size_t at_;
};

}  // namespace

TextPart parts_of(std::string_view text, const JsonValue& json) {
  return PartScanner(text).document(json);
}

}  // namespace terrazzo
