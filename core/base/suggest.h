#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace terrazzo {

/// The closest match for `wrong`: a name that differs only in case and word separators (- or _), else the nearest by
/// edit distance. The first of several equally near ones; empty if none is near enough.
std::string nearest(std::string_view wrong, const std::vector<std::string>& names);

/// ` (did you mean "x"?)`, or empty if no name is near. For messages that list the valid names themselves, or where
/// there are too many.
std::string did_you_mean(std::string_view wrong, const std::vector<std::string>& names);

/// The end of a message about an unknown name: ` (did you mean "x"?)`, or the list of valid names if none is near, or
/// empty if there are none.
std::string suggestion(std::string_view wrong, const std::vector<std::string>& names);

/// `"a", "b" or "c"` without duplicates; shortened if there are many.
std::string listed(const std::vector<std::string>& all);

}  // namespace terrazzo
