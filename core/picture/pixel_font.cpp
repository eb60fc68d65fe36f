#include "core/picture/pixel_font.h"

#include <array>
#include <string>

namespace terrazzo {

namespace {

constexpr int glyph_width = glyph_advance - 1;

/// Characters side by side, drawn as text.
struct Band {
  std::string_view characters;
  std::array<std::string_view, glyph_height> rows;
};

// clang-format off
constexpr Band bands[] = {
    {"ABCDEFGHIJKLMNOPQR", {
        " ###  ####   ###  ####  ##### #####  ###  #   #  ###    ### #   # #     #   # #   #  ###  ####   ###  ####",
        "#   # #   # #   # #   # #     #     #   # #   #   #      #  #  #  #     ## ## ##  # #   # #   # #   # #   #",
        "#   # #   # #     #   # #     #     #     #   #   #      #  # #   #     # # # ##  # #   # #   # #   # #   #",
        "##### ####  #     #   # ####  ####  # ### #####   #      #  ##    #     # # # # # # #   # ####  #   # ####",
        "#   # #   # #     #   # #     #     #   # #   #   #      #  # #   #     #   # #  ## #   # #     # # # # #",
        "#   # #   # #   # #   # #     #     #   # #   #   #   #  #  #  #  #     #   # #  ## #   # #     #  #  #  #",
        "#   # ####   ###  ####  ##### #      ###  #   #  ###   ##   #   # ##### #   # #   #  ###  #      ## # #   #",
    }},
    {"STUVWXYZ0123456789", {
        " #### ##### #   # #   # #   # #   # #   # #####  ###    #    ###   ###     #  #####  ###  #####  ###   ###",
        "#       #   #   # #   # #   # #   # #   #     # #   #  ##   #   # #   #   ##  #     #         # #   # #   #",
        "#       #   #   # #   # #   #  # #   # #     #  #  ##   #       #     #  # #  ####  #        #  #   # #   #",
        " ###    #   #   # #   # # # #   #     #     #   # # #   #      #    ##  #  #      # ####     #   ###   ####",
        "    #   #   #   #  # #  # # #  # #    #    #    ##  #   #     #       # #####     # #   #   #   #   #     #",
        "    #   #   #   #  # #  ## ## #   #   #   #     #   #   #    #    #   #    #  #   # #   #   #   #   #     #",
        "####    #    ###    #   #   # #   #   #   #####  ###   ###  #####  ###     #   ###   ###    #    ###   ###",
    }},
    {".,:;!?'\"()[]+-*/=_", {
        "                          #    ###    #    # #     #   #     ###   ###                        #",
        "             ##    ##     #   #   #   #    # #    #     #    #       #    #         # # #     #",
        "             ##    ##     #       #              #       #   #       #    #          ###     #  #####",
        "                          #      #               #       #   #       #  ##### ##### #####   #",
        "       ##    ##    ##     #     #                #       #   #       #    #          ###   #    #####",
        " ##     #    ##     #                             #     #    #       #    #         # # # #",
        " ##    #           #      #     #                  #   #     ###   ###                    #           #####",
    }},
    {"<>%#&", {
        "   #   #    ##  #  # #   ##",
        "  #     #   ##  #  # #  #  #",
        " #       #     #  ##### # #",
        "#         #   #    # #   #",
        " #       #   #    ##### # # #",
        "  #     #   #  ##  # #  #  #",
        "   #   #    #  ##  # #   ## #",
    }},
};
// clang-format on

bool is_continuation(char c) {
  return (static_cast<unsigned char>(c) & 0xc0) == 0x80;
}

char capital(char c) {
  return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
}

bool is_set(const Band& band, size_t character, int x, int y) {
  const std::string_view row = band.rows[size_t(y)];
  const size_t at = character * glyph_advance + size_t(x);
  return at < row.size() && row[at] == '#';
}

bool is_set(char c, int x, int y) {
  if (c == ' ') return false;
  for (const Band& band : bands)
    if (const size_t at = band.characters.find(capital(c)); at != band.characters.npos) return is_set(band, at, x, y);
  return x == 0 || y == 0 || x == glyph_width - 1 || y == glyph_height - 1;
}

}  // namespace

int character_count(std::string_view text) {
  int count = 0;
  for (const char c : text) count += !is_continuation(c);
  return count;
}

std::string shortened(std::string_view text, int most) {
  if (character_count(text) <= most) return std::string(text);
  if (most < 2) return {};
  size_t end = 0;
  for (int kept = 0; kept < most - 2 || is_continuation(text[end]); end++) kept += !is_continuation(text[end]);
  return std::string(text.substr(0, end)) + "..";
}

std::vector<std::string> wrapped(std::string_view text, int most, int most_lines) {
  std::vector<std::string> lines;
  for (size_t at = text.find_first_not_of(' '); at < text.size(); at = text.find_first_not_of(' ', at)) {
    const size_t end = std::min(text.find(' ', at), text.size());
    const std::string word(text.substr(at, end - at));
    const bool fits = !lines.empty() && character_count(lines.back()) + 1 + character_count(word) <= most;
    if (fits || int(lines.size()) == most_lines)
      lines.back() += " " + word;
    else
      lines.push_back(word);
    at = end;
  }
  for (std::string& line : lines) line = shortened(line, most);
  std::erase(lines, "");
  return lines;
}

void for_each_dot(std::string_view text, const std::function<void(int x, int y)>& dot) {
  int left = 0;
  for (const char c : text) {
    if (is_continuation(c)) continue;
    for (int y = 0; y < glyph_height; y++)
      for (int x = 0; x < glyph_width; x++)
        if (is_set(c, x, y)) dot(left + x, y);
    left += glyph_advance;
  }
}

}  // namespace terrazzo
