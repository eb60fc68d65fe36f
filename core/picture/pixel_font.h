#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// A built-in font of 5x7 dots for captions in pictures. Small letters are shown as capitals; any character that the
/// font lacks is a hollow box. Text is UTF-8. Thread-safe.
namespace terrazzo {

inline constexpr int glyph_height = 7;
/// Dots from the beginning of one character to that of the next, one of them empty.
inline constexpr int glyph_advance = 6;

/// How many characters the text has.
int character_count(std::string_view text);

/// The text if it has at most `most` characters, else its beginning and two dots; nothing if not even they fit.
std::string shortened(std::string_view text, int most);

/// The text in at most `most_lines` lines of at most `most` characters, broken at spaces; words, and a last line, that
/// are too long are shortened. No lines if the text is empty, or nothing of it fits.
std::vector<std::string> wrapped(std::string_view text, int most, int most_lines);

/// Calls `dot(x, y)` for every dot that is set, counted from the top left of the first character.
void for_each_dot(std::string_view text, const std::function<void(int x, int y)>& dot);

}  // namespace terrazzo
