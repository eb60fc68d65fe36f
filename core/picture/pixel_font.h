#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// A built-in font of 5x7 dots for captions in pictures. Lower-case letters are shown as capitals, missing characters
/// as hollow boxes. Text is UTF-8. Thread-safe. Own dots since pictures would otherwise depend on a font
/// library's version and on the fonts that are installed.
namespace terrazzo {

inline constexpr int glyph_height = 7;
/// The distance between the starts of adjacent characters in dots, including one empty dot.
inline constexpr int glyph_advance = 6;

/// The number of characters in the text.
int character_count(std::string_view text);

/// The text truncated to `most` characters, with two dots at the end; empty if not even the dots fit.
std::string shortened(std::string_view text, int most);

/// The text in at most `most_lines` lines of at most `most` characters, broken at spaces; long words and a long last
/// line are shortened. Empty if the text is empty or nothing fits.
std::vector<std::string> wrapped(std::string_view text, int most, int most_lines);

/// Calls `dot(x, y)` for every set dot, with coordinates from the top left of the first character.
void for_each_dot(std::string_view text, const std::function<void(int x, int y)>& dot);

}  // namespace terrazzo
