#pragma once

#include <string>
#include <string_view>

namespace terrazzo {

/// The result of merging two changes of a document.
struct MergedText {
  std::string text;      ///< `theirs` with the changes of `mine`
  std::string conflict;  ///< what both changed differently, as a sentence; `text` is then empty
};

/// A three-way merge, member by member: changes of different members go together. Lists and values are wholes. A
/// conflict also if one of the texts is not JSON, or if comments would be lost.
MergedText merged(std::string_view base, std::string_view mine, std::string_view theirs);

}  // namespace terrazzo
