#pragma once

#include <optional>
#include <vector>

#include "core/naming/file_words.h"
#include "core/naming/map_words.h"

/// Finds the keywords in a file's name that tell which maps it holds.
namespace terrazzo {

/// The matched words [first, last) of a name.
struct KeywordMatch {
  std::vector<WordPart> parts{};  ///< empty: no match
  size_t first = 0, last = 0;
  std::optional<NormalY> normal_y{};  ///< if the keyword or a word beside it states the convention

  explicit operator bool() const { return !parts.empty(); }
};

/// Finds the last valid keyword. `channels`: of the file; 0 if unknown.
KeywordMatch find_keyword(const std::vector<NameWord>& words, int channels);

/// The number of relevant words after the match: 1 for basecolor_boosted, 0 for basecolor_2k.
int further_words(const std::vector<NameWord>& words, const KeywordMatch& match);

/// Removes the workflow at the end of Poliigon's names: COL_2K_METALNESS is no metallic map.
std::vector<NameWord> without_workflow(std::vector<NameWord> words, int channels);

/// Matches a name that contains only a normal convention as normals: slate-ogl, wall_2k_dx. Requires at least two
/// channels, or an unknown number (0).
KeywordMatch normals_by_convention(const std::vector<NameWord>& words, int channels);

}  // namespace terrazzo
