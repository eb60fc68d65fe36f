#include "graphs/text/edit.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "graphs/text/format.h"
#include "graphs/text/part_matching.h"

namespace terrazzo {

namespace {

bool has_break(std::string_view text) {
  return text.find('\n') != text.npos;
}
bool has_comment(std::string_view text) {
  return text.find("//") != text.npos;
}
/// What follows the last line break.
std::string_view last_line(std::string_view text) {
  return text.substr(text.rfind('\n') + 1);
}
bool is_blank(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == text.npos;
}

/// Writes a document's text anew, and copies what stays.
class ChangeWriter {
 public:
  explicit ChangeWriter(std::string_view text) : text_(text) {
    const size_t end = text.find('\n');
    if (end != text.npos && end > 0 && text[end - 1] == '\r') break_ = "\r\n";
  }

  std::string run(const TextPart& before, const JsonValue& after) {
    if (!before.entries.empty()) {
      const std::string_view lead = slice(before.entries.front().lead, before.entries.front().name);
      if (has_break(lead) && !last_line(lead).empty() && is_blank(last_line(lead))) unit_ = last_line(lead);
    }
    has_lines_ = has_break(slice(before.begin, before.end));
    out_ = text_.substr(0, before.begin);
    value(before, after, {});
    return out_ + std::string(text_.substr(before.end));
  }

 private:
  /// A container's surroundings.
  struct Site {
    int of_graph = 0;
    bool is_alone = false;  ///< its entry has lines of its own
    size_t behind = 0;
  };

  std::string_view slice(size_t begin, size_t end) const { return text_.substr(begin, end - begin); }

  std::string current_indent() const {
    const std::string_view line = last_line(out_);
    return std::string(line.substr(0, line.find_first_not_of(" \t")));
  }
  size_t current_column() const { return out_.size() - (out_.rfind('\n') + 1); }

  std::string fresh(const JsonValue& v, const Site& site) const {
    if (!has_lines_) return compact(v);
    std::string text = formatted_at(v, {site.of_graph, current_indent(), unit_, current_column(), site.behind});
    if (break_ == "\n") return text;
    std::string out;
    for (const char c : text) out += c == '\n' ? break_ : std::string(1, c);
    return out;
  }

  void value(const TextPart& before, const JsonValue& after, const Site& site) {
    const JsonValue& old = *before.json;
    const bool is_container = (old.is_object() && after.is_object()) || (old.is_list() && after.is_list());
    const std::string_view as_is = slice(before.begin, before.end);
    if (same_value(old, after)) {
      out_ += as_is;
    } else if (!is_container || (site.is_alone && site.of_graph > 1 && is_canonical_line(as_is, old, site))) {
      // An entry in the canonical form keeps it, and so is broken into lines once it is too long.
      out_ += fresh(after, site);
    } else {
      container(before, after, site);
    }
  }

  bool is_canonical_line(std::string_view as_is, const JsonValue& v, const Site& site) const {
    return as_is == compact(v) && as_is == fresh(v, site);
  }

  /// Whether the entry begins and ends its lines.
  bool is_alone(const TextPart& in, size_t i) const {
    const TextEntry& e = in.entries[i];
    const size_t next = i + 1 < in.entries.size() ? in.entries[i + 1].lead : in.close_lead;
    const size_t next_end = i + 1 < in.entries.size() ? in.entries[i + 1].name : in.end;
    return has_break(slice(e.lead, e.name)) && has_break(slice(next, next_end));
  }

  void container(const TextPart& before, const JsonValue& after, const Site& site);
  void lead_of(const TextPart& before, size_t i, size_t previous, bool is_first);
  void keep_comments(const TextPart& before, size_t begin, size_t end, std::string_view next_lead);
  void new_entry(const JsonValue& after, size_t k, const Site& site, bool own_line, bool is_first);
  void copied_entry(const TextPart& before, size_t i, const JsonValue& after, size_t k, const Site& site);

  /// No more than a comment may be on the line of a comment.
  void end_comment_line(std::string_view lead) {
    if (ends_in_comment_ && !has_break(lead)) out_ += break_ + entry_indent_;
    ends_in_comment_ = false;
  }

  static const JsonValue& child(const JsonValue& v, size_t k) {
    return v.is_object() ? v.members[k].value : v.items[k];
  }

  std::string_view text_;
  std::string out_;
  std::string break_ = "\n", unit_ = "  ";
  std::string entry_indent_;
  bool has_lines_ = false;
  bool ends_in_comment_ = false;
};

/// Of the removed entries from `begin` to `end`: comments above a blank line, which are about more than one entry.
void ChangeWriter::keep_comments(const TextPart& before, size_t begin, size_t end, std::string_view next_lead) {
  for (size_t i = begin; i < end; i++) {
    const std::string_view lead = slice(before.entries[i].lead, before.entries[i].name);
    size_t kept = 0;  // the end of the last line that stays
    for (size_t at = lead.find('\n'); at != lead.npos; at = lead.find('\n', at + 1)) {
      const size_t line_end = lead.find('\n', at + 1);
      if (line_end == lead.npos) break;
      if (is_blank(lead.substr(at + 1, line_end - at - 1)) && has_comment(lead.substr(0, at))) kept = at;
    }
    if (kept == 0) continue;
    if (kept > 0 && lead[kept - 1] == '\r') kept--;
    end_comment_line("\n");
    out_ += lead.substr(0, kept);
    const size_t line_end = next_lead.find('\n', next_lead.find('\n') + 1);
    const bool has_blank = line_end != next_lead.npos && is_blank(next_lead.substr(0, line_end));
    if (!has_blank) out_ += break_;
  }
}

/// Writes what comes before the name of entry `i`. `previous`: the entries from here to `i` have been removed.
void ChangeWriter::lead_of(const TextPart& before, size_t i, size_t previous, bool is_first) {
  std::string_view lead = slice(before.entries[i].lead, before.entries[i].name);
  keep_comments(before, previous, i, lead);
  std::string_view first_removed;
  if (previous < i) first_removed = slice(before.entries[previous].lead, before.entries[previous].name);
  if (!has_break(lead) && has_break(first_removed)) {
    end_comment_line("\n");
    out_ += break_ + std::string(last_line(first_removed));
    return;
  }
  if (is_first && previous < i && !has_comment(lead)) {
    if (!has_break(first_removed)) {
      lead = first_removed;
    } else {
      // No blank line after the bracket.
      out_ += break_ + std::string(last_line(lead));
      ends_in_comment_ = false;
      return;
    }
  }
  end_comment_line(lead);
  out_ += lead;
}

void ChangeWriter::new_entry(const JsonValue& after, size_t k, const Site& site, bool own_line, bool is_first) {
  const JsonValue& v = child(after, k);
  if (own_line) {
    ends_in_comment_ = false;
    for (const std::string& c : v.comments_before) out_ += break_ + (c.empty() ? "" : entry_indent_ + c);
    out_ += break_ + entry_indent_;
  } else {
    end_comment_line("");
    if (!is_first) out_ += " ";
  }
  if (after.is_object()) out_ += in_quotes(after.members[k].name) + ": ";
  out_ += fresh(v, {depth_inside(site.of_graph, after.is_object() ? after.members[k].name : ""), own_line, 1});
}

void ChangeWriter::copied_entry(const TextPart& before, size_t i, const JsonValue& after, size_t k, const Site& site) {
  const TextEntry& e = before.entries[i];
  const bool is_object = after.is_object();
  const std::string name = is_object ? after.members[k].name : "";
  if (is_object)
    out_ += name == before.json->members[i].name ? std::string(slice(e.name, e.name_end)) : in_quotes(name);
  out_ += slice(e.name_end, e.value.begin);
  const std::string outer = entry_indent_;
  value(e.value, child(after, k), {depth_inside(site.of_graph, name), is_alone(before, i), 1});
  entry_indent_ = outer;
}

void ChangeWriter::container(const TextPart& before, const JsonValue& after, const Site& site) {
  const std::vector<TextEntry>& entries = before.entries;
  const std::vector<EntryMatch> matches = matched_entries(before, after);
  const std::string base_indent = current_indent();
  const char open = after.is_object() ? '{' : '[', close = after.is_object() ? '}' : ']';
  out_ += slice(before.begin, before.head_end);
  ends_in_comment_ = has_comment(slice(before.begin + 1, before.head_end));
  std::string_view close_lead = slice(before.close_lead, before.end - 1);
  if (matches.empty()) {  // nothing is left
    keep_comments(before, 0, entries.size(), close_lead);
    if (has_comment(close_lead) || out_.back() != open) {
      end_comment_line(close_lead);
      out_ += close_lead;
    }
    out_ += close;
    return;
  }
  bool opens_lines = false;  // an empty container gets its entries on lines of their own
  if (entries.empty()) {
    const size_t end = close_lead.rfind('\n');
    opens_lines = has_break(close_lead) || ends_in_comment_ || (site.of_graph <= 1 && after.is_object() && has_lines_);
    if (end != close_lead.npos) {
      const size_t begin = end > 0 && close_lead[end - 1] == '\r' ? end - 1 : end;
      out_ += close_lead.substr(0, begin);
      close_lead = close_lead.substr(begin);
    } else if (is_blank(close_lead) && !opens_lines) {
      out_ += close_lead;
    }
  }
  const bool has_trailing_comma = !entries.empty() && entries.back().has_comma;
  entry_indent_ = base_indent + unit_;
  size_t next = 0;  // of the entries, the first that has not been passed
  for (size_t n = 0; n < matches.size(); n++) {
    const size_t k = matches[n].now, i = matches[n].before;
    const bool is_last = n + 1 == matches.size();
    const bool needs_comma = !is_last || has_trailing_comma;
    if (i == no_match) {
      const size_t neighbour = next > 0 ? next - 1 : 0;
      const bool own_line = entries.empty() ? opens_lines : is_alone(before, neighbour);
      if (!entries.empty() && own_line) {
        const TextEntry& e = entries[neighbour];
        entry_indent_ = last_line(slice(e.lead, e.name));
      }
      const bool has_own_line = own_line || ends_in_comment_;
      if (n == 0 && !entries.empty() && !has_own_line) out_ += slice(entries.front().lead, entries.front().name);
      new_entry(after, k, site, has_own_line, n == 0);
      if (needs_comma) out_ += ",";
      if (const std::string& comment = child(after, k).comment_after; !comment.empty() && has_own_line) {
        out_ += "  " + comment;
        ends_in_comment_ = true;
      }
      continue;
    }
    const TextEntry& e = entries[i];
    const size_t written = out_.size();
    lead_of(before, i, next, n == 0);
    if (out_.size() == written && n > 0 && matches[n - 1].before == no_match) out_ += " ";
    if (has_break(slice(e.lead, e.name))) entry_indent_ = last_line(slice(e.lead, e.name));
    copied_entry(before, i, after, k, site);
    if (e.has_comma) out_ += slice(e.value.end, e.comma);
    if (needs_comma) out_ += ",";
    out_ += slice(e.tail, e.tail_end);
    ends_in_comment_ = has_comment(slice(e.tail, e.tail_end));
    next = i + 1;
  }
  keep_comments(before, next, entries.size(), close_lead);
  if (entries.empty() && opens_lines && !has_break(close_lead)) close_lead = {};
  const bool must_break = ends_in_comment_ || (entries.empty() && opens_lines);
  if (must_break && !has_break(close_lead)) out_ += break_ + base_indent;
  ends_in_comment_ = false;
  if (!entries.empty() || has_break(close_lead) || !opens_lines) out_ += close_lead;
  out_ += close;
}

}  // namespace

JsonValue json_in(std::string_view text) {
  ParsedJson parsed = parse_json(text);
  if (!parsed.value) throw Error("the document is not JSON: " + parsed.problems.front().message);
  return std::move(*parsed.value);
}

std::string with_changes(std::string_view text, const JsonValue& after) {
  const JsonValue before = json_in(text);
  return ChangeWriter(text).run(parts_of(text, before), after);
}

std::string with_value(const std::string& text, const std::vector<std::string>& path, const JsonValue& value) {
  JsonValue document = json_in(text);
  JsonValue* at = &document;
  for (const std::string& name : path) {
    if (!at->is_object())
      throw Error(fmt::format("{} cannot be set: it would be inside {}", in_quotes(name), found(*at)));
    if (!at->find(name)) at->set(name, JsonValue::empty_object());
    at = at->find(name);
  }
  *at = value;
  return with_changes(text, document);
}

}  // namespace terrazzo
