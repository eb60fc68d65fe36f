#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "graphs/text/json.h"

/// Changes of a document's text that leave all other bytes as they are: order, comments, spelling, white space.
namespace terrazzo {

/// The text changed so that it reads as `after`. That is made from parse_json(text): parts with the same place are the
/// same ones, so members may have other names. What is equal stays, byte for byte; a removed member goes with the
/// comments that belong to it; a new one is written in the style of its neighbours, with its comments. Comments of
/// parts that stay are not looked at. Throws Error if the text is not JSON.
std::string with_changes(std::string_view text, const JsonValue& after);

/// Sets the value at `path` in the text of a document. `path` lists member names from the outside in. New members are
/// appended to their object. Throws Error if the text is not JSON, or if a parent on the path is no object.
std::string with_value(const std::string& text, const std::vector<std::string>& path, const JsonValue& value);

/// The document in a text. Throws Error if it is not JSON.
JsonValue json_in(std::string_view text);

}  // namespace terrazzo
