#include "runner/python/waiting.h"

#include <chrono>
#include <exception>
#include <thread>

#include <pybind11/pybind11.h>

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
  // Notified under the lock: the one who waits may destroy this as soon as it has seen it.
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

}  // namespace terrazzo::python
