#include "core/naming/file_words.h"

#include <algorithm>
#include <array>
#include <set>

#include "core/base/text.h"

namespace terrazzo {

namespace {

bool is_upper(char c) {
  return c >= 'A' && c <= 'Z';
}
bool is_lower(char c) {
  return c >= 'a' && c <= 'z';
}

bool all_digits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
}

/// u1, v1, var2, v02: the word and at most three letters of it before digits.
std::string before_digits(const std::string& word) {
  const size_t digits = word.find_first_of("0123456789");
  return digits != std::string::npos && digits <= 3 ? word.substr(0, digits) : "";
}

/// "lod" and a number after it.
void join_levels_of_detail(std::vector<NameWord>& words) {
  for (size_t i = 0; i + 1 < words.size(); i++) {
    if (words[i].text != "lod" || !all_digits(words[i + 1].text)) continue;
    words[i].text += words[i + 1].text;
    words[i].end = words[i + 1].end;
    words.erase(words.begin() + ptrdiff_t(i) + 1);
  }
}

}  // namespace

std::vector<NameWord> words_in(std::string_view text) {
  std::vector<NameWord> words;
  bool within = false;
  for (size_t i = 0; i < text.size(); i++) {
    const char c = text[i], before = i ? text[i - 1] : '_', after = i + 1 < text.size() ? text[i + 1] : '_';
    const bool part_of_word = is_word(c) ? c != '_' : static_cast<unsigned char>(c) >= 128;
    const bool camel = is_upper(c) && (is_lower(before) || (is_upper(before) && is_lower(after)) ||
                                       (is_digit(before) && is_lower(after)));
    if (!part_of_word || camel) within = false;
    if (!part_of_word) continue;
    if (!within) words.push_back({"", i, i});
    within = true;
    words.back().text += c;
    words.back().end = i + 1;
  }
  for (NameWord& w : words) w.text = lowercase(w.text);
  join_levels_of_detail(words);
  return words;
}

std::vector<NameWord> words_of_file(std::string_view name) {
  return words_in(name.substr(0, name.rfind('.')));
}

std::string extension_of(std::string_view name) {
  const size_t dot = name.rfind('.');
  return dot == std::string_view::npos ? "" : lowercase(name.substr(dot + 1));
}

std::optional<NormalY> convention(std::string_view word) {
  if (word == "gl" || word == "ogl" || word == "opengl") return NormalY::up;
  if (word == "dx" || word == "directx" || word == "d3d") return NormalY::down;
  return std::nullopt;
}

bool is_neutral(const std::string& word) {
  static const std::set<std::string> known = {
      "jpg", "jpeg", "png", "tif",   "tiff",   "exr",      "tga",    "map",      "tex", "texture", "image",
      "img", "srgb", "raw", "lin",   "linear", "rec709",   "acescg", "utility",  "var", "open",    "direct",
      "x",   "u",    "v",   "final", "copy",   "seamless", "tile",   "tileable", "sml"};
  return is_digit(word[0]) || known.count(word) || convention(word) || known.count(before_digits(word)) ||
         level_of_detail(word);
}

bool is_resolution(const std::string& word) {
  constexpr std::array powers = {"64", "128", "256", "512", "1024", "2048", "4096", "8192", "16384", "32768"};
  if (std::find(powers.begin(), powers.end(), word) != powers.end()) return true;
  if (word.size() > 1 && word.back() == 'k') return all_digits(word.substr(0, word.size() - 1));
  const size_t x = word.find('x');
  return x != std::string::npos && all_digits(word.substr(0, x)) && all_digits(word.substr(x + 1));
}

bool says_no_material(const std::string& word) {
  static const std::set<std::string> known = {"jpg",    "jpeg", "png",   "tif",   "tiff",   "exr",
                                              "tga",    "hdr",  "webp",  "srgb",  "linear", "rec709",
                                              "acescg", "8bit", "16bit", "32bit", "v",      "var"};
  return is_resolution(word) || is_filler(word) || known.count(word) || convention(word) ||
         before_digits(word) == "v" || before_digits(word) == "var" || level_of_detail(word);
}

bool is_filler(const std::string& word) {
  static const std::set<std::string> known = {"map", "maps", "tex", "texture", "textures", "image", "img"};
  return known.count(word) > 0;
}

std::optional<int> level_of_detail(const std::string& word) {
  constexpr size_t most_digits = 2;
  if (!word.starts_with("lod") || word.size() > 3 + most_digits || !all_digits(std::string_view(word).substr(3)))
    return std::nullopt;
  return std::stoi(word.substr(3));
}

std::string without_digits(const std::string& word) {
  size_t begin = 0, end = word.size();
  while (begin < end && is_digit(word[begin])) begin++;
  while (end > begin && is_digit(word[end - 1])) end--;
  return word.substr(begin, end - begin);
}

}  // namespace terrazzo
