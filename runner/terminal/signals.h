#pragma once

#include <atomic>

namespace terrazzo {

/// While it lives, the first SIGINT, SIGTERM or SIGHUP sets the flag, for an orderly stop; the second one ends the
/// program at once. SIGPIPE is ignored. At most one object at a time.
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
