#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "graphs/text/json.h"

/// Where the values of a parsed document are in its text, to the byte.
namespace terrazzo {

struct TextEntry;

/// A value, from `begin` up to `end`.
struct TextPart {
  const JsonValue* json = nullptr;
  size_t begin = 0, end = 0;
  size_t head_end = 0;             ///< of a list or an object: the end of the bracket's line if no entry is on it
  std::vector<TextEntry> entries;  ///< members or items
  size_t close_lead = 0;           ///< the closing bracket, with the white space and comments before it
};

/// A member or item: lead, name, value, gap, comma, tail.
struct TextEntry {
  size_t lead = 0;                ///< white space and comments before it
  size_t name = 0, name_end = 0;  ///< both are the value's begin in a list
  TextPart value;
  size_t comma = 0;  ///< the value's end if it has none
  bool has_comma = false;
  size_t tail = 0, tail_end = 0;  ///< the rest of its line, if no other entry is on that; without the line's end
};

/// `json` is the value parsed from `text`, and must outlive the result.
TextPart parts_of(std::string_view text, const JsonValue& json);

}  // namespace terrazzo
