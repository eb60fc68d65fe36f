#include "runner/signals.h"

#include <csignal>

namespace terrazzo {

namespace {

std::atomic<bool> cancelled{false};
static_assert(std::atomic<bool>::is_always_lock_free, "it is set in a signal handler");

void handle(int) {
  cancelled = true;
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace

CancelOnSignal::CancelOnSignal() {
  cancelled = false;
  std::signal(SIGINT, handle);
  std::signal(SIGTERM, handle);
}

CancelOnSignal::~CancelOnSignal() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

const std::atomic<bool>& CancelOnSignal::flag() const {
  return cancelled;
}

}  // namespace terrazzo
