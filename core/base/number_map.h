#pragma once

#include <map>
#include <string>
#include <vector>

namespace terrazzo {

using Numbers = std::vector<double>;
/// Numbers by name, one or several each: {"normal": 2, "base_color": [1, 1, 0.5]}.
using NumberMap = std::map<std::string, Numbers>;

}  // namespace terrazzo
