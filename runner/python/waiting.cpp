#include "runner/python/waiting.h"

#include <chrono>
#include <exception>
#include <set>
#include <thread>

#include <pybind11/pybind11.h>

#include "core/base/error.h"

namespace terrazzo::python {

namespace py = pybind11;

void Events::add(Event event) {
  {
    const std::lock_guard lock(mutex_);
    if (event.kind == "progress")
      for (Event& e : waiting_)
        if (e.kind == event.kind && e.node == event.node) {
          e.fraction = event.fraction;
          return;
        }
    waiting_.push_back(std::move(event));
  }
  something_.notify_one();
}

void Events::finish() {
  // Notifies while holding the mutex: the waiting thread may destroy this object right after.
  const std::lock_guard lock(mutex_);
  over_ = true;
  something_.notify_one();
}

bool Events::wait(std::vector<Event>& out) {
  std::unique_lock lock(mutex_);
  something_.wait_for(lock, std::chrono::milliseconds(50), [&] { return over_ || !waiting_.empty(); });
  out.clear();
  out.swap(waiting_);
  return !over_;
}

void do_and_wait(const std::function<void()>& work, std::atomic<bool>& cancelled, Events& events,
                 const std::function<void(const Event&)>& deliver) {
  const WorkInProgress in_progress(&cancelled);
  std::exception_ptr failure, interruption;
  std::thread helper([&] {
    try {
      work();
    } catch (...) {
      failure = std::current_exception();
    }
    events.finish();
  });
  std::vector<Event> batch;
  for (bool goes_on = true; goes_on;) {
    {
      const py::gil_scoped_release free;
      goes_on = events.wait(batch);
    }
    try {
      for (const Event& e : batch)
        if (!interruption && deliver) deliver(e);
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    } catch (...) {
      if (!interruption) interruption = std::current_exception();
      cancelled = true;
    }
  }
  {
    const py::gil_scoped_release free;
    helper.join();
  }
  if (interruption) std::rethrow_exception(interruption);
  if (failure) std::rethrow_exception(failure);
}

void do_and_wait(const std::function<void()>& work, std::atomic<bool>& cancelled) {
  Events none;
  do_and_wait(work, cancelled, none, {});
}

namespace {

struct AllWork {
  std::mutex mutex;
  std::condition_variable over;
  std::multiset<std::atomic<bool>*> in_progress;
  bool is_ending = false;
};

/// Never destroyed: threads may outlive Python.
AllWork& all_work() {
  static auto& all = *new AllWork;
  return all;
}

}  // namespace

WorkInProgress::WorkInProgress(std::atomic<bool>* cancelled) : cancelled_(cancelled) {
  AllWork& all = all_work();
  const std::lock_guard lock(all.mutex);
  if (all.is_ending) throw Error("Python is ending; nothing new is begun");
  all.in_progress.insert(cancelled_);
}

WorkInProgress::~WorkInProgress() {
  AllWork& all = all_work();
  const std::lock_guard lock(all.mutex);
  all.in_progress.erase(all.in_progress.find(cancelled_));
  all.over.notify_all();
}

void end_work() {
  constexpr auto patience = std::chrono::seconds(60);  // a Python node may not check for cancellation
  AllWork& all = all_work();
  const py::gil_scoped_release free;
  std::unique_lock lock(all.mutex);
  all.is_ending = true;
  for (std::atomic<bool>* cancelled : all.in_progress)
    if (cancelled) *cancelled = true;
  all.over.wait_for(lock, patience, [&] { return all.in_progress.empty(); });
}

}  // namespace terrazzo::python
