#pragma once

#include <optional>
#include <vector>

#include "core/naming/file_words.h"
#include "core/naming/map_words.h"

/// The words of a file's name that say which maps it holds.
namespace terrazzo {

/// Words [first, last) of a name.
struct KeywordMatch {
  std::vector<WordPart> parts{};  ///< empty: no words say it
  size_t first = 0, last = 0;
  std::optional<NormalY> normal_y{};  ///< if the words for normals, or words beside them, say it

  explicit operator bool() const { return !parts.empty(); }
};

/// The last keyword that counts. `channels`: of the file, 0 if not known.
KeywordMatch find_keyword(const std::vector<NameWord>& words, int channels);

/// How many words behind the match say something of their own: 1 of basecolor_boosted, 0 of basecolor_2k.
int further_words(const std::vector<NameWord>& words, const KeywordMatch& match);

/// Poliigon ends names with the workflow that a map is for: COL_2K_METALNESS is no metallic map.
std::vector<NameWord> without_workflow(std::vector<NameWord> words, int channels);

/// A name that says only which way green points is that of normals: slate-ogl, wall_2k_dx. Of a file of two channels
/// or more, or of which that is not known (0).
KeywordMatch normals_by_convention(const std::vector<NameWord>& words, int channels);

}  // namespace terrazzo
