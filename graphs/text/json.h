#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "graphs/text/problem.h"

/// JSON for graph files. Values know their line and column, `//` comments are kept, trailing commas are allowed, and
/// objects keep their order.
namespace terrazzo {

struct JsonMember;

struct JsonValue {
  enum class Kind : uint8_t { null, boolean, integer, number, text, list, object };
  Kind kind = Kind::null;
  bool boolean = false;
  int64_t integer = 0;
  double number = 0;  ///< set for integers as well
  std::string text;   ///< the text, or a number's spelling in the file
  std::vector<JsonValue> items;
  std::vector<JsonMember> members;
  Place place;
  /// Comment lines above the value, or above the name of a member; empty for a blank line.
  std::vector<std::string> comments_before;
  std::string comment_after;                 ///< a comment at the end of the value's line
  std::vector<std::string> comments_inside;  ///< comment lines before the closing bracket, or after the document

  bool is_text() const { return kind == Kind::text; }
  bool is_list() const { return kind == Kind::list; }
  bool is_object() const { return kind == Kind::object; }
  bool is_number() const { return kind == Kind::integer || kind == Kind::number; }
  /// Null if this is no object or has no such member.
  const JsonValue* find(std::string_view name) const;
  JsonValue* find(std::string_view name);

  /// Sets a member of an object; appends it if it is new.
  void set(const std::string& name, JsonValue value);

  static JsonValue of(std::string text);
  static JsonValue empty_object();
  static JsonValue of(int64_t integer);
};

struct JsonMember {
  std::string name;
  Place place;
  JsonValue value;
};

/// The deepest nesting of objects and lists.
inline constexpr int json_depth_limit = 64;

struct ParsedJson {
  std::optional<JsonValue> value;  ///< nullopt after a syntax error
  std::vector<Problem> problems;   ///< the first syntax error, and all duplicate names in objects
};

/// Parses UTF-8 text. Columns count characters. Skips a byte order mark. Never throws because of `text`.
///
/// A hand-written recursive descent parser. A reader on nlohmann-json's SAX interface (3.11.2) was compared with it.
/// That library reports neither the places of tokens, nor comments, nor the spelling of integers; it reads 01 as two
/// numbers and a zero byte as the end of the file. So each event had to find its token again, and each message had to
/// parse the text a second time. It read the same values from 200,000 mutated documents, but needed 351 lines instead
/// of 336, 1.3 times as long for 20 MB, and 84 KB of code instead of 49 KB.
ParsedJson parse_json(std::string_view text);

/// The JSON pointer (RFC 6901) to the value at a place of a document: a member (at its name or value), an item of a
/// list, or else the enclosing value.
std::string pointer_to(const JsonValue& document, Place place);

/// The JSON pointer of a path of names and positions.
std::string pointer_of(const std::vector<std::string>& path);

/// Whether both read the same: places, comments and the order of members do not count; 1 and 1.0 differ.
bool same_value(const JsonValue& a, const JsonValue& b);

/// Describes a value for messages: `the text "abc"`, `the number 3`, `a list of 2`, ...
std::string found(const JsonValue& value);
/// A text as a quoted and escaped JSON string.
std::string in_quotes(std::string_view text);
/// A quoted text for a message. A long one is cut off, with "and so on" after it.
std::string excerpt(std::string_view text, size_t most = 200);

}  // namespace terrazzo
