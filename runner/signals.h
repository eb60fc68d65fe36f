#pragma once

#include <atomic>

namespace terrazzo {

/// While it lives, the first SIGINT or SIGTERM sets the flag, so that a run can stop in good order; the second one ends
/// the program at once. One at a time.
class CancelOnSignal {
 public:
  CancelOnSignal();
  ~CancelOnSignal();
  CancelOnSignal(const CancelOnSignal&) = delete;
  CancelOnSignal& operator=(const CancelOnSignal&) = delete;
  const std::atomic<bool>& flag() const;
};

}  // namespace terrazzo
