#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"

/// The words of file names.
namespace terrazzo {

/// A word in lower case, and where it stands in the name.
struct NameWord {
  std::string text;
  size_t begin = 0, end = 0;
};

/// The words of a text: cut at everything that is no letter or digit, and where camel case begins a word (NormalGL ->
/// normal, gl; AOMap -> ao, map). A level of detail is one word: LOD_1 -> lod1.
std::vector<NameWord> words_in(std::string_view text);
/// The same for a file's name without its extension.
std::vector<NameWord> words_of_file(std::string_view name);

/// In lower case, without the dot; empty if there is none.
std::string extension_of(std::string_view name);

/// Which way green points, if the word says it: gl, directx, ...
std::optional<NormalY> convention(std::string_view word);

/// Whether a word says nothing about which map it is: sizes, versions, formats, colour spaces, normal conventions.
bool is_neutral(const std::string& word);

/// Whether a word says nothing about which material it is. Unlike is_neutral it lets most numbers count: wall_01 and
/// wall_02 are two.
bool says_no_material(const std::string& word);

/// Whether a word stands in front of many names without naming anything: texture, tex, map, ...
bool is_filler(const std::string& word);

/// "2k", "1024", "4096x4096".
bool is_resolution(const std::string& word);

/// 1 of "lod1"; nullopt of words that name no level of detail.
std::optional<int> level_of_detail(const std::string& word);

/// Without the digits that it begins and ends with.
std::string without_digits(const std::string& word);

}  // namespace terrazzo
