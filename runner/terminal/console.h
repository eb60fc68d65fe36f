#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/printable.h"

namespace terrazzo {

/// Writes a message to standard error with control characters escaped. Ignores errors, so that a closed pipe does not
/// stop a run.
template <typename... Values>
void print_message(fmt::format_string<Values...> format, Values&&... values) {
  const std::string message = printable(fmt::format(format, std::forward<Values>(values)...));
  std::fwrite(message.data(), 1, message.size(), stderr);
}

/// Writes the output of a command to standard output. Errors are reported once, at the end: see result_failure.
void write_result(std::string_view text);
template <typename... Values>
void print_result(fmt::format_string<Values...> format, Values&&... values) {
  write_result(fmt::format(format, std::forward<Values>(values)...));
}
/// Rows of texts; the first is the header.
using Table = std::vector<std::vector<std::string>>;
/// The table with aligned columns, one line per row.
std::string aligned(const Table& table);
/// errno of the first failed write_result; 0 if all output was written.
int result_failure();

}  // namespace terrazzo
