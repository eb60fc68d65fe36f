#pragma once

#include <cstdio>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace terrazzo {

/// Writes a message to standard error. If that is full or closed the message is lost, but never the work: no error.
template <typename... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
  const std::string message = fmt::format(format, std::forward<Values>(values)...);
  std::fwrite(message.data(), 1, message.size(), stderr);
}

}  // namespace terrazzo
