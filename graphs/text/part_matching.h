#pragma once

#include <cstddef>
#include <vector>

#include "graphs/text/text_parts.h"

namespace terrazzo {

inline constexpr size_t no_match = static_cast<size_t>(-1);

/// A member or item of a changed value: its position there, and that of the entry of the text that it is.
struct EntryMatch {
  size_t now = 0;
  size_t before = no_match;  ///< no_match if it is new
};

/// The members or items of `after` in the order in which they are written. Entries that stay keep their order: that of
/// members does not count.
std::vector<EntryMatch> matched_entries(const TextPart& before, const JsonValue& after);

}  // namespace terrazzo
