#include "runner/terminal/signals.h"

#include <csignal>

namespace terrazzo {

namespace {

std::atomic<bool> cancelled{false};
static_assert(std::atomic<bool>::is_always_lock_free, "it is set in a signal handler");
constexpr int ending_signals[] = {SIGINT, SIGTERM, SIGHUP};

/// A signal that was ignored at startup (as by nohup) stays ignored.
void set_unless_ignored(int signal, void (*handler)(int)) {
  if (std::signal(signal, handler) == SIG_IGN) std::signal(signal, SIG_IGN);
}

void handle(int) {
  cancelled = true;
  for (const int signal : ending_signals) set_unless_ignored(signal, SIG_DFL);
}

}  // namespace

CancelOnSignal::CancelOnSignal() : pipe_handler_before_(std::signal(SIGPIPE, SIG_IGN)) {
  cancelled = false;
  for (const int signal : ending_signals) set_unless_ignored(signal, handle);
}

CancelOnSignal::~CancelOnSignal() {
  for (const int signal : ending_signals) set_unless_ignored(signal, SIG_DFL);
  std::signal(SIGPIPE, pipe_handler_before_);
}

const std::atomic<bool>& CancelOnSignal::flag() const {
  return cancelled;
}

}  // namespace terrazzo
