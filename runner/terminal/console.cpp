#include "runner/terminal/console.h"

#include <cerrno>

namespace terrazzo {

namespace {

int first_failure = 0;

}  // namespace

void write_result(std::string_view text) {
  errno = 0;
  const bool arrived = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!arrived && first_failure == 0) first_failure = errno != 0 ? errno : EIO;
}

int result_failure() {
  return first_failure;
}

std::string aligned(const Table& table) {
  std::vector<size_t> widths;
  for (const auto& row : table) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (size_t c = 0; c < row.size(); c++) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string out;
  for (const auto& row : table) {
    std::string line;
    for (size_t c = 0; c < row.size(); c++) line += fmt::format("{:<{}}  ", row[c], widths[c]);
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

}  // namespace terrazzo
