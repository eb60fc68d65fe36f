#pragma once

#include <atomic>

namespace terrazzo {

/// While it lives, the first SIGINT, SIGTERM or SIGHUP sets the flag, so that a run can stop in good order; the second
/// one ends the program at once. A reader of the messages that goes away (SIGPIPE) does not stop the run. One at a
/// time.
class CancelOnSignal {
 public:
  CancelOnSignal();
  ~CancelOnSignal();
  CancelOnSignal(const CancelOnSignal&) = delete;
  CancelOnSignal& operator=(const CancelOnSignal&) = delete;
  const std::atomic<bool>& flag() const;

 private:
  void (*pipe_handler_before_)(int);
};

}  // namespace terrazzo
