#include "graphs/text/edit.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "graphs/text/format.h"

namespace terrazzo {

namespace {

constexpr std::string_view spaces = " \t\r\n";

/// The offset of a place in the text. Columns count characters, without a byte order mark.
size_t offset_of(std::string_view text, Place place) {
  size_t at = text.starts_with("\xef\xbb\xbf") ? 3 : 0;
  for (int line = 1; line < place.line; line++) at = text.find('\n', at) + 1;
  const auto continues = [&] { return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80; };
  for (int column = 1; column < place.column; column++) {
    at++;
    while (continues()) at++;
  }
  return at;
}

/// The offset after the string that begins with the quote at `at`.
size_t end_of_text(std::string_view text, size_t at) {
  for (at++; at < text.size() && text[at] != '"'; at++)
    if (text[at] == '\\') at++;
  return at + 1;
}

size_t end_of_comment(std::string_view text, size_t at) {
  return std::min(text.find('\n', at), text.size());
}

/// The offset after the value that begins at `at`.
size_t end_of_value(std::string_view text, size_t at) {
  if (text[at] == '"') return end_of_text(text, at);
  if (text[at] != '{' && text[at] != '[') return std::min(text.find_first_of(",]}/ \t\r\n", at), text.size());
  int depth = 0;
  while (at < text.size()) {
    const char c = text[at];
    if (c == '"') {
      at = end_of_text(text, at);
      continue;
    }
    if (text.substr(at, 2) == "//") {
      at = end_of_comment(text, at);
      continue;
    }
    at++;
    if (c == '{' || c == '[') depth++;
    if ((c == '}' || c == ']') && --depth == 0) break;
  }
  return at;
}

/// The offset after white space and comments.
size_t next_token(std::string_view text, size_t at) {
  while (at < text.size()) {
    if (text.substr(at, 2) == "//")
      at = end_of_comment(text, at);
    else if (spaces.find(text[at]) == spaces.npos)
      break;
    else
      at++;
  }
  return at;
}

/// Appends a member to the object that begins at `begin`.
std::string with_member(std::string text, const JsonValue& object, size_t begin, const std::string& member) {
  if (object.members.empty()) return text.insert(begin + 1, member);
  const JsonMember& last = object.members.back();
  const size_t name = offset_of(text, last.place);
  const size_t end = end_of_value(text, offset_of(text, last.value.place));
  const size_t next = next_token(text, end);
  const bool has_comma = next < text.size() && text[next] == ',';
  const size_t line = text.rfind('\n', name) + 1;
  const std::string indent = text.substr(line, name - line);
  const size_t line_end = text.find('\n', has_comma ? next : end);
  const bool is_alone = indent.find_first_not_of(" \t") == indent.npos && line > begin &&
                        next_token(text, has_comma ? next + 1 : end) > line_end;
  if (!is_alone) return has_comma ? text.insert(next + 1, " " + member) : text.insert(end, ", " + member);
  const bool returns = text[line_end - 1] == '\r';
  text.insert(line_end - (returns ? 1 : 0), (returns ? "\r\n" : "\n") + indent + member + (has_comma ? "," : ""));
  if (!has_comma) text.insert(end, ",");
  return text;
}

}  // namespace

std::string with_value(const std::string& text, const std::vector<std::string>& path, const JsonValue& value) {
  const ParsedJson parsed = parse_json(text);
  if (!parsed.value) throw Error("the document is not JSON: " + parsed.problems.front().message);
  const JsonValue* at = &*parsed.value;
  for (size_t i = 0; i < path.size(); i++) {
    if (!at->is_object())
      throw Error(fmt::format("{} cannot be set: it would be inside {}", in_quotes(path[i]), found(*at)));
    const JsonValue* inner = at->find(path[i]);
    if (!inner) {
      std::string member = compact(value);
      for (size_t k = path.size(); k-- > i;)
        member = fmt::format("{}: {}", in_quotes(path[k]), k + 1 < path.size() ? "{" + member + "}" : member);
      return with_member(text, *at, offset_of(text, at->place), member);
    }
    at = inner;
  }
  const size_t begin = offset_of(text, at->place);
  return std::string(text).replace(begin, end_of_value(text, begin) - begin, compact(value));
}

}  // namespace terrazzo
