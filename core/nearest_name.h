#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace terrazzo {

/// The candidate that `name` was most likely meant to be: fewest edits (case does not count), the first of equals.
/// Empty if none is near, that is within a third of the longer name's length, or two edits for short names.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

/// `; did you mean "x"?`, or nothing if no candidate is near: the end of an error message.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace terrazzo
