#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace terrazzo {

/// The name most like `wrong`: one with the same letters, whatever their case and what joins words (- or _), else by
/// edit distance. The first of several equally near ones; empty if none is near enough to be meant.
std::string nearest(std::string_view wrong, const std::vector<std::string>& names);

/// ` (did you mean "x"?)`, or nothing if no name is near: for messages that list the valid names themselves, or where
/// these are too many.
std::string did_you_mean(std::string_view wrong, const std::vector<std::string>& names);

/// The end of a message about an unknown name: ` (did you mean "x"?)`, or the valid names if none is near, or
/// nothing if there are none.
std::string suggestion(std::string_view wrong, const std::vector<std::string>& names);

/// `"a", "b" or "c"`, each once; shortened if there are many.
std::string listed(const std::vector<std::string>& all);

}  // namespace terrazzo
