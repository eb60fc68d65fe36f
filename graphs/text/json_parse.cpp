#include <charconv>
#include <set>

#include <fmt/format.h>

#include "core/base/text.h"
#include "graphs/text/json.h"
#include "graphs/text/utf8.h"

namespace terrazzo {

namespace {

using Kind = JsonValue::Kind;

/// A recursive descent parser for valid UTF-8. Throws the first syntax error as a Problem.
class Parser {
 public:
  Parser(std::string_view text, size_t start) : text_(text), at_(start), counted_(start) {}

  JsonValue document() {
    skip_space();
    if (at_end()) fail("the file is empty; expected a graph, which begins with {");
    std::vector<std::string> above = take_comments(Blank::below);
    JsonValue value = parse_value(0, "a value");
    value.comments_before = std::move(above);
    skip_space();
    if (!at_end()) fail("expected the end of the file after the last bracket, found " + found_here());
    for (std::string& c : take_comments(Blank::above)) value.comments_inside.push_back(std::move(c));
    return value;
  }

  std::vector<Problem> duplicates;

 private:
  struct Comment {
    std::string text;
    int line = 0;
  };

  bool at_end() const { return at_ >= text_.size(); }
  char peek() const { return at_end() ? '\0' : text_[at_]; }
  bool next_is(std::string_view s) const { return text_.substr(at_, s.size()) == s; }

  /// Continues counting from the last call, since a file may be one long line.
  Place place() {
    for (; counted_ < at_; counted_++) column_ += (static_cast<uint8_t>(text_[counted_]) & 0xC0) != 0x80;
    return {line_, column_};
  }
  [[noreturn]] void fail(const std::string& message) { throw Problem{place(), "", message}; }

  std::string found_here() const {
    if (at_end()) return "the end of the file";
    size_t length = 0;
    while (length < 24 && at_ + length < text_.size() && is_word(text_[at_ + length])) length++;
    if (length > 0) return std::string(text_.substr(at_, length));
    if (peek() == '"') {
      const size_t end = text_.find_first_of("\"\n", at_ + 1);
      return end < at_ + 24 && text_[end] == '"' ? std::string(text_.substr(at_, end + 1 - at_)) : "a text";
    }
    if (static_cast<uint8_t>(peek()) < 0x20 || peek() == 0x7F) return fmt::format("the byte {:#04x}", peek());
    return fmt::format("\"{}\"", text_.substr(at_, utf8_length(text_, at_)));
  }

  void skip_space() {
    is_blank_ = false;
    for (; !at_end(); at_++) {
      const char c = peek();
      if (c == '\n') {
        const bool is_second = !comments_.empty() && comments_.back().text.empty();
        if (is_blank_ && !is_second) comments_.push_back({"", line_});
        is_blank_ = true;
        line_++;
        counted_ = at_ + 1;
        column_ = 1;
      } else if (next_is("//")) {
        skip_comment();
      } else if (next_is("/*") || c == '#') {
        fail("comments begin with // and end with the line");
      } else if (c != ' ' && c != '\t' && c != '\r') {
        return;
      }
    }
  }

  /// Stops before the last character of the comment, which the caller skips.
  void skip_comment() {
    size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view comment = text_.substr(at_, end - at_);
    while (!comment.empty() && (comment.back() == '\r' || comment.back() == ' ')) comment.remove_suffix(1);
    comments_.push_back({std::string(comment), line_});
    is_blank_ = false;
    at_ = end - 1;
  }

  /// Where blank lines are kept, in addition to those between comments.
  enum class Blank : uint8_t { above, below, both };

  std::vector<std::string> take_comments(Blank blank = Blank::both) {
    std::vector<std::string> all;
    for (Comment& c : comments_) all.push_back(std::move(c.text));
    comments_.clear();
    if (blank == Blank::below && !all.empty() && all.front().empty()) all.erase(all.begin());
    if (blank == Blank::above && !all.empty() && all.back().empty()) all.pop_back();
    return all;
  }
  /// The comment on `line` after the value that was just read.
  std::string take_comment_on(int line) {
    if (comments_.empty() || comments_.front().line != line) return "";
    std::string text = std::move(comments_.front().text);
    comments_.erase(comments_.begin());
    return text;
  }

  JsonValue parse_value(int depth, std::string_view expected) {
    JsonValue v;
    v.place = place();
    const char c = peek();
    if (c == '{' || c == '[') {
      if (depth >= json_depth_limit) fail(fmt::format("nested deeper than {} levels", json_depth_limit));
      if (c == '{') parse_object(v, depth + 1);
      if (c == '[') parse_list(v, depth + 1);
    } else if (c == '"') {
      v.kind = Kind::text;
      v.text = parse_text();
    } else if (is_digit(c) || c == '-' || c == '+' || c == '.') {
      parse_number(v);
    } else {
      parse_word(v, expected);
    }
    return v;
  }

  void parse_word(JsonValue& v, std::string_view expected) {
    size_t length = 0;
    while (at_ + length < text_.size() && is_word(text_[at_ + length])) length++;
    const std::string_view word = text_.substr(at_, length);
    if (word == "true" || word == "false") {
      v.kind = Kind::boolean;
      v.boolean = word == "true";
    } else if (word != "null") {
      if (peek() == '\'') fail("texts need double quotes (\"), found a single quote");
      const std::string hint = word == "True" || word == "yes" || word == "TRUE" || word == "on"     ? "; write true"
                               : word == "False" || word == "no" || word == "FALSE" || word == "off" ? "; write false"
                               : length > 0 ? "; texts need double quotes (\")"
                                            : "";
      fail(fmt::format("expected {}, found {}{}", expected, found_here(), hint));
    }
    at_ += length;
  }

  void parse_number(JsonValue& v) {
    const size_t begin = at_;
    size_t i = at_;
    const auto digits = [&] {
      const size_t first = i;
      while (i < text_.size() && is_digit(text_[i])) i++;
      return i - first;
    };
    bool well_formed = true, whole = true;
    if (i < text_.size() && text_[i] == '-') i++;
    const size_t leading = i;
    well_formed &= digits() > 0;
    well_formed &= i - leading < 2 || text_[leading] != '0';
    if (i < text_.size() && text_[i] == '.') {
      i++;
      whole = false;
      well_formed &= digits() > 0;
    }
    if (i < text_.size() && (text_[i] == 'e' || text_[i] == 'E')) {
      i++;
      whole = false;
      if (i < text_.size() && (text_[i] == '+' || text_[i] == '-')) i++;
      well_formed &= digits() > 0;
    }
    while (i < text_.size() && (is_word(text_[i]) || text_[i] == '.' || text_[i] == '+')) {
      i++;
      well_formed = false;
    }
    v.text = text_.substr(begin, i - begin);
    if (!well_formed) fail(fmt::format("expected a number such as 3, -1.5 or 2e-3, found {}", v.text.substr(0, 24)));
    const char* end = v.text.data() + v.text.size();
    if (std::from_chars(v.text.data(), end, v.number).ec != std::errc())
      fail(fmt::format("the number {} is too large to compute with", v.text.substr(0, 24)));
    v.kind = whole && std::from_chars(v.text.data(), end, v.integer).ec == std::errc() ? Kind::integer : Kind::number;
    at_ = i;
  }

  std::string parse_text() {
    const Place begin = place();
    std::string out;
    at_++;
    while (peek() != '"') {
      if (at_end() || peek() == '\n')
        fail(fmt::format("the text that begins at column {} has no closing quote (\") on its line", begin.column));
      if (static_cast<uint8_t>(peek()) < 0x20)
        fail(fmt::format("{} must be escaped in a text; write {}", found_here(),
                         peek() == '\t' ? "\\t" : fmt::format("\\u{:04x}", peek())));
      if (peek() == '\\') {
        parse_escape(out);
      } else {
        out += text_[at_++];
      }
    }
    at_++;
    return out;
  }

  void parse_escape(std::string& out) {
    constexpr std::string_view names = "\"\\/bfnrt", meanings = "\"\\/\b\f\n\r\t";
    const char c = at_ + 1 < text_.size() ? text_[at_ + 1] : '\0';
    if (const size_t known = names.find(c); c != '\0' && known != names.npos) {
      out += meanings[known];
      at_ += 2;
      return;
    }
    if (c != 'u') fail("expected one of \\\" \\\\ \\/ \\b \\f \\n \\r \\t \\u; a plain backslash is written \\\\");
    uint32_t point = parse_unicode_escape();
    if (point >= 0xD800 && point < 0xDC00 && next_is("\\u")) {
      const uint32_t low = parse_unicode_escape();
      if (low < 0xDC00 || low > 0xDFFF) fail("expected the second half of a surrogate pair before this");
      point = 0x10000 + ((point - 0xD800) << 10) + (low - 0xDC00);
    }
    if (point >= 0xD800 && point < 0xE000) fail("expected the first half of a surrogate pair before this");
    if (point == 0) fail("\\u0000 is not allowed in a text");
    append_utf8(out, point);
  }

  uint32_t parse_unicode_escape() {
    uint32_t point = 0;
    const std::string_view hex = text_.substr(std::min(at_ + 2, text_.size()), 4);
    const auto read = std::from_chars(hex.data(), hex.data() + hex.size(), point, 16);
    if (hex.size() < 4 || read.ptr != hex.data() + 4) fail("expected four hexadecimal digits after \\u");
    at_ += 6;
    return point;
  }

  /// Reads a comma or the closing bracket. Returns true if another entry must follow.
  bool more_follow(JsonValue& container, JsonValue& last, char close, std::string_view entry) {
    const int line = line_;
    skip_space();
    last.comment_after = take_comment_on(line);
    if (peek() == close) return end_of(container);
    if (peek() != ',') {
      const Place p = container.place;
      const char begin = close == '}' ? '{' : '[';
      fail(fmt::format("expected \",\" and another {}, or \"{}\" for the \"{}\" at line {}, column {}; found {}", entry,
                       close, begin, p.line, p.column, found_here()));
    }
    const int comma_line = line_;
    at_++;
    skip_space();
    if (last.comment_after.empty()) last.comment_after = take_comment_on(comma_line);
    return peek() == close ? end_of(container) : true;  // trailing commas are accepted, like comments
  }

  /// Skips the closing bracket.
  bool end_of(JsonValue& container) {
    for (std::string& c : take_comments(Blank::above)) container.comments_inside.push_back(std::move(c));
    at_++;
    return false;
  }

  /// Skips the opening bracket. Returns false if the container is empty; it is then closed.
  bool open(JsonValue& container, char close) {
    at_++;
    skip_space();
    if (peek() != close) return true;
    container.comments_inside = take_comments(Blank::above);
    at_++;
    return false;
  }

  void parse_list(JsonValue& list, int depth) {
    list.kind = Kind::list;
    if (!open(list, ']')) return;
    do {
      std::vector<std::string> above = take_comments(list.items.empty() ? Blank::below : Blank::both);
      list.items.push_back(parse_value(depth, "a value or \"]\""));
      list.items.back().comments_before = std::move(above);
    } while (more_follow(list, list.items.back(), ']', "value"));
  }

  void parse_object(JsonValue& object, int depth) {
    object.kind = Kind::object;
    if (!open(object, '}')) return;
    std::set<std::string> seen;
    do {
      std::vector<std::string> above = take_comments(object.members.empty() ? Blank::below : Blank::both);
      JsonMember m{.name = "", .place = place(), .value = {}};
      if (peek() != '"')
        fail(fmt::format("expected a name in double quotes (\"){}, found {}", object.members.empty() ? " or \"}\"" : "",
                         found_here()));
      m.name = parse_text();
      skip_space();
      if (peek() != ':')
        fail(fmt::format("expected \":\" after the name {}, found {}", in_quotes(m.name), found_here()));
      at_++;
      skip_space();
      if (!seen.insert(m.name).second)
        duplicates.push_back({m.place, "",
                              fmt::format("{} is given twice; the first is at line {}", in_quotes(m.name),
                                          object.find(m.name)->place.line)});
      m.value = parse_value(depth, fmt::format("a value for {}", in_quotes(m.name)));
      m.value.comments_before = std::move(above);
      object.members.push_back(std::move(m));
    } while (more_follow(object, object.members.back().value, '}', "entry"));
  }

  std::string_view text_;
  size_t at_;
  int line_ = 1;
  int column_ = 1;  ///< column of the character at counted_
  size_t counted_;
  std::vector<Comment> comments_;  ///< comments not attached yet; a blank line is one without text
  bool is_blank_ = false;          ///< the line is empty so far
};

std::optional<Problem> encoding_problem(std::string_view text) {
  if (text.starts_with("\xFE\xFF") || text.starts_with("\xFF\xFE"))
    return Problem{{1, 1}, "", "the file is UTF-16; save it as UTF-8"};
  Place place{1, 1};
  for (size_t at = 0; at < text.size();) {
    const size_t length = utf8_length(text, at);
    if (length == 0)
      return Problem{
          place, "",
          fmt::format("the byte {:#04x} is not UTF-8; save the file as UTF-8", static_cast<uint8_t>(text[at]))};
    place = text[at] == '\n' ? Place{place.line + 1, 1} : Place{place.line, place.column + 1};
    at += length;
  }
  return std::nullopt;
}

}  // namespace

ParsedJson parse_json(std::string_view text) {
  if (std::optional<Problem> problem = encoding_problem(text)) return {std::nullopt, {std::move(*problem)}};
  Parser parser(text, text.starts_with("\xEF\xBB\xBF") ? 3 : 0);
  try {
    JsonValue value = parser.document();
    return {std::move(value), std::move(parser.duplicates)};
  } catch (Problem& syntax) {
    parser.duplicates.push_back(std::move(syntax));
    return {std::nullopt, std::move(parser.duplicates)};
  }
}

}  // namespace terrazzo
