#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

/// Long work for a Python program: on a thread of its own, so that the caller can deliver events and notice Ctrl-C.
namespace terrazzo::python {

/// What has happened in a run.
struct Event {
  std::string kind;  ///< planned, started, waits, progress, note, finished, reused, spared, failed
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

}  // namespace terrazzo::python
