#pragma once

#include <string>
#include <string_view>

namespace terrazzo {

/// A text of a document in quotes, for a message: of a long one the beginning, with "and so on" behind it.
std::string excerpt(std::string_view text, size_t most = 200);

}  // namespace terrazzo
