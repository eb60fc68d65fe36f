#include "runner/cli/console.h"

#include <cerrno>

namespace terrazzo {

namespace {

int first_failure = 0;

}  // namespace

void write_answer(std::string_view text) {
  errno = 0;
  const bool arrived = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!arrived && first_failure == 0) first_failure = errno != 0 ? errno : EIO;
}

int answer_failure() {
  return first_failure;
}

}  // namespace terrazzo
