#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"

/// Splits file names into words and classifies them.
namespace terrazzo {

/// A word in lower case, and its position in the name.
struct NameWord {
  std::string text;
  size_t begin = 0, end = 0;
};

/// The words of a text, split at characters other than letters and digits and at camel case (NormalGL -> normal, gl;
/// AOMap -> ao, map). A level of detail is one word: LOD_1 -> lod1.
std::vector<NameWord> words_in(std::string_view text);
/// The same for a file's name without its extension.
std::vector<NameWord> words_of_file(std::string_view name);

/// In lower case, without the dot; empty if there is none.
std::string extension_of(std::string_view name);

/// The normal convention that a word names: gl, directx, ...
std::optional<NormalY> convention(std::string_view word);

/// Whether a word is irrelevant to the map: sizes, versions, formats, colour spaces, normal conventions.
bool is_neutral(const std::string& word);

/// Whether a word is irrelevant to the material. Unlike for is_neutral, most numbers are relevant: wall_01 and wall_02
/// are different materials.
bool says_no_material(const std::string& word);

/// Whether a word is a common meaningless prefix: texture, tex, map, ...
bool is_filler(const std::string& word);

/// "2k", "1024", "4096x4096".
bool is_resolution(const std::string& word);

/// 1 for "lod1"; nullopt if the word is no level of detail.
std::optional<int> level_of_detail(const std::string& word);

/// Without leading and trailing digits.
std::string without_digits(const std::string& word);

}  // namespace terrazzo
