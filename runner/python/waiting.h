#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "runner/python/texts.h"

/// Long work for a Python program: on a thread of its own, so that the caller can deliver events and notice Ctrl-C.
namespace terrazzo::python {

/// What has happened in a run.
struct Event {
  std::string kind;  ///< planned, started, waits, progress, note, finished, reused, not_needed, failed
  std::string node{};
  std::string message{};
  double fraction = 0;
  double seconds = 0;
  int total = 0;  ///< of planned: how many nodes are to run or are reused
};

/// Events on their way from any thread to the one that waits. Nobody holds Python's lock while holding its mutex.
class Events {
 public:
  /// Of what a node says of its progress, only the last is kept.
  void add(Event event);
  void finish();
  /// Waits until there is something, or for a twentieth of a second. False once the work is over; `out` has the rest.
  bool wait(std::vector<Event>& out);

 private:
  std::mutex mutex_;
  std::condition_variable something_;
  std::vector<Event> waiting_;
  bool over_ = false;
};

/// Does `work` on another thread. Meanwhile this one, which must hold Python's lock and gives it up while it waits,
/// hands events to `deliver` and lets Python look at signals. If one of these raises, it sets `cancelled`, waits for
/// the end of the work, and raises that; else what the work throws.
void do_and_wait(const std::function<void()>& work, std::atomic<bool>& cancelled, Events& events,
                 const std::function<void(const Event&)>& deliver);

/// The same without events.
void do_and_wait(const std::function<void()>& work, std::atomic<bool>& cancelled);

/// Work that Python's end waits for: a thread that wants the lock after that is ended in the midst of C++, which ends
/// the process. `cancelled`, if not null, is set when Python ends. Throws Error if it is ending already.
class WorkInProgress {
 public:
  explicit WorkInProgress(std::atomic<bool>* cancelled = nullptr);
  ~WorkInProgress();
  WorkInProgress(const WorkInProgress&) = delete;
  WorkInProgress& operator=(const WorkInProgress&) = delete;

 private:
  std::atomic<bool>* cancelled_;
};

/// Does without Python's lock for as long as it lives.
class Unlocked {
  const WorkInProgress work_;  // over only when the lock is held again
  const pybind11::gil_scoped_release free_;
};

/// Cancels all work and waits for its end, when Python ends. Needs Python's lock, which it gives up.
void end_work();

}  // namespace terrazzo::python
