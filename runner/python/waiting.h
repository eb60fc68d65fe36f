#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "runner/python/texts.h"

/// Runs long work for Python on its own thread, so that the caller can deliver events and notice Ctrl-C.
namespace terrazzo::python {

/// An event of a run.
struct Event {
  std::string kind;  ///< planned, started, waits, progress, note, finished, reused, not_needed, failed
  std::string node{};
  std::string message{};
  double fraction = 0;
  double seconds = 0;
  int total = 0;  ///< for planned: the number of nodes to run or reuse
};

/// A queue of events from any thread to the waiting one. Nobody may hold the GIL while holding its mutex.
class Events {
 public:
  /// Keeps only the latest progress event of a node.
  void add(Event event);
  void finish();
  /// Waits for events, at most 50 ms. Returns false once the work is over; `out` then holds the remaining events.
  bool wait(std::vector<Event>& out);

 private:
  std::mutex mutex_;
  std::condition_variable something_;
  std::vector<Event> waiting_;
  bool over_ = false;
};

/// Runs `work` on another thread. Meanwhile the calling thread, which must hold the GIL and releases it while waiting,
/// passes events to `deliver` and lets Python check for signals. If either raises, sets `cancelled`, waits for the work
/// to end and rethrows; else throws what the work throws.
void do_and_wait(const std::function<void()>& work, std::atomic<bool>& cancelled, Events& events,
                 const std::function<void(const Event&)>& deliver);

/// The same without events.
void do_and_wait(const std::function<void()>& work, std::atomic<bool>& cancelled);

/// Work that Python's shutdown waits for: a thread that takes the GIL after shutdown is killed inside C++ code, which
/// aborts the process. `cancelled`, if not null, is set at shutdown. Throws Error if shutdown has begun.
class WorkInProgress {
 public:
  explicit WorkInProgress(std::atomic<bool>* cancelled = nullptr);
  ~WorkInProgress();
  WorkInProgress(const WorkInProgress&) = delete;
  WorkInProgress& operator=(const WorkInProgress&) = delete;

 private:
  std::atomic<bool>* cancelled_;
};

/// Releases the GIL while it lives.
class Unlocked {
  const WorkInProgress work_;  // ends only after the GIL is held again
  const pybind11::gil_scoped_release free_;
};

/// At Python's shutdown, cancels all work and waits for its end. The caller must hold the GIL, which is released while
/// waiting.
void end_work();

}  // namespace terrazzo::python
