#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace terrazzo {

/// Writes a message to standard error. If that is full or closed the message is lost, but never the work: no error.
template <typename... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
  const std::string message = fmt::format(format, std::forward<Values>(values)...);
  std::fwrite(message.data(), 1, message.size(), stderr);
}

/// Writes what a command was asked for to standard output. That it could not be written is no error here but once, when
/// the command is over: see answer_failure.
void write_answer(std::string_view text);
template <typename... Values>
void answer(fmt::format_string<Values...> format, Values&&... values) {
  write_answer(fmt::format(format, std::forward<Values>(values)...));
}
/// The system's number of the error for which part of an answer was lost; 0 if all of it has been written.
int answer_failure();

}  // namespace terrazzo
