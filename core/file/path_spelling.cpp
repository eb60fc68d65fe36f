#include "core/file/path_spelling.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "core/base/text.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 0x20;
}

bool is_foreign(std::string_view name) {
  return std::ranges::any_of(name, [](char c) { return c == '\\' || is_control(c); });
}

/// The letter of the escape that a JSON text has for a character: t of a tab.
char escape_of(char c) {
  constexpr std::string_view characters = "\b\t\n\f\r", letters = "btnfr";
  const size_t at = characters.find(c);
  return at == characters.npos ? '_' : letters[at];
}

std::string with_slashes(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool separates = c == '\\' || is_control(c);
    if (separates && !out.ends_with('/')) out += '/';
    if (is_control(c)) out += escape_of(c);
    if (!separates) out += c;
  }
  return out;
}

}  // namespace

std::string path_advice(const fs::path& base, const std::string& text) {
  const bool has_drive = text.size() > 2 && is_letter(text[0]) && text[1] == ':' && (text[2] == '\\' || text[2] == '/');
  if (!has_drive && !is_foreign(text)) return "";
  fs::path prefix = base;
  bool is_there = true;
  std::error_code failure;
  for (bool first = true; const fs::path& part : fs::path(text)) {
    prefix /= part;
    if (is_foreign(part.native()) || (first && has_drive)) is_there &= fs::exists(prefix, failure);
    first = false;
  }
  if (is_there) return "";
  if (has_drive)
    return fmt::format("{}: is a drive of Windows; name the place as this system knows it, such as /mnt/{}{}", text[0],
                       lowercase(text.substr(0, 1)), with_slashes(text.substr(2)));
  return fmt::format("folders are separated by /: write \"{}\"", with_slashes(text));
}

}  // namespace terrazzo
