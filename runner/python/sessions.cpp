#include <algorithm>
#include <mutex>
#include <set>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "runner/api/session.h"
#include "runner/python/bindings.h"
#include "runner/python/errors.h"
#include "runner/python/graphs.h"
#include "runner/python/opened_files.h"
#include "runner/python/values.h"
#include "runner/python/waiting.h"

namespace terrazzo::python {

namespace py = pybind11;

namespace {

/// Converts a run's notifications to events.
class Watcher : public RunObserver {
 public:
  explicit Watcher(Events& events) : events_(events) {}
  void planned(const Plan& plan) override {
    const auto expected = std::ranges::count_if(plan.stages, [](const Stage& s) { return s.expected(); });
    events_.add({.kind = "planned", .message = plan.summary(), .total = int(expected)});
  }
  void started(const Stage& s) override { events_.add({.kind = "started", .node = s.node->name}); }
  void waits(const Stage& s) override { events_.add({.kind = "waits", .node = s.node->name}); }
  void progressed(const Stage& s, double fraction) override {
    events_.add({.kind = "progress", .node = s.node->name, .fraction = fraction});
  }
  void noted(const Stage& s, const std::string& message) override {
    events_.add({.kind = "note", .node = s.node->name, .message = message});
  }
  void finished(const Stage& s, double seconds) override {
    events_.add({.kind = "finished", .node = s.node->name, .fraction = 1, .seconds = seconds});
  }
  void reused(const Stage& s) override { events_.add({.kind = "reused", .node = s.node->name, .fraction = 1}); }
  void not_needed(const Stage& s) override { events_.add({.kind = "not_needed", .node = s.node->name}); }
  void failed(const Stage& s, const std::string& message) override {
    events_.add({.kind = "failed", .node = s.node->name, .message = message});
  }

 private:
  Events& events_;
};

std::string_view name_of(StageOutcome::Kind kind) {
  constexpr std::array<std::string_view, 5> names = {"idle", "reused", "run", "failed", "unfinished"};
  return names[static_cast<size_t>(kind)];
}

/// Nodes whose values are returned by default: the requested ones, else, in a graph without sinks, its results.
std::vector<std::string> kept_of_itself(const Graph& graph, const std::vector<std::string>& only) {
  std::vector<std::string> out;
  if (!only.empty()) {
    for (const std::string& name : nodes_meant(graph, only)) {
      const GraphNode* node = graph.find(name);
      if (!node || !node->type->outputs.empty()) out.push_back(name);
    }
    return out;
  }
  std::set<std::string> read;
  for (const GraphNode& n : graph.nodes) {
    if (n.type->is_sink()) return {};
    for (const auto& [port, wires] : n.inputs)
      for (const Wire& w : wires) read.insert(w.node);
  }
  for (const GraphNode& n : graph.nodes)
    if (!read.contains(n.name)) out.push_back(n.name);
  return out;
}

py::dict as_dict(const RunResult& result) {
  py::dict kept, out;
  for (const auto& [node, values] : result.kept) {
    py::dict ports;
    for (const auto& [port, value] : values) ports[py::str(port)] = to_python(value);
    kept[py::str(node)] = ports;
  }
  py::list failures, stages;
  for (const Failure& f : result.failures) failures.append(py::make_tuple(f.node, f.message));
  for (const StageOutcome& s : result.stages) {
    std::vector<std::filesystem::path> files;
    for (const OutputFile& f : s.files) files.push_back(f.path);
    stages.append(py::make_tuple(s.node, name_of(s.kind), s.reason, s.seconds, s.notes, files));
  }
  out["cancelled"] = result.cancelled;
  out["failures"] = failures;
  out["kept"] = kept;
  out["stages"] = stages;
  out["seconds"] = result.seconds;
  out["summary"] = result.summary();
  return out;
}

/// A session that may be closed during runs: the last run closes the cache.
class SessionHandle {
 public:
  SessionHandle(std::filesystem::path cache, bool use_cache, int threads, uint64_t memory, bool checked) {
    if (checked) tell_opened_files();
    const Unlocked free;
    session_ = std::make_shared<Session>(SessionOptions{std::move(cache), use_cache, threads, memory, checked});
  }

  py::dict run(const CheckedHandle& graph, std::vector<std::string> only, const std::vector<std::string>& keep,
               const py::object& progress) {
    const std::shared_ptr<Session> session = open();
    std::vector<std::string> kept = kept_of_itself(graph.checked.graph(), only);
    kept.insert(kept.end(), keep.begin(), keep.end());
    Events events;
    Watcher watcher(events);
    std::atomic<bool> cancelled = false;
    const Running running(*this, cancelled);
    const bool is_watched = !progress.is_none();
    RunResult result;
    const auto work = [&] {
      result = session->run(graph.checked, {.only = std::move(only),
                                            .keep = std::move(kept),
                                            .observer = is_watched ? &watcher : nullptr,
                                            .cancelled = &cancelled});
    };
    const auto deliver = [&](const Event& e) { progress(e.kind, e.node, e.message, e.fraction, e.seconds, e.total); };
    try {
      do_and_wait(work, cancelled, events, is_watched ? deliver : std::function<void(const Event&)>());
    } catch (const GraphError& e) {
      raise(e, graph.job);
    }
    return as_dict(result);
  }

  py::dict plan(const CheckedHandle& graph, const std::vector<std::string>& only) {
    const std::shared_ptr<Session> session = open();
    const Plan plan = for_job(graph.job, [&] { return session->plan(graph.checked, {.only = only}); });
    py::list stages;
    for (const Stage& s : plan.stages)
      stages.append(py::make_tuple(s.node->name, terrazzo::name_of(s.state), s.reason, s.expected_seconds));
    py::dict out;
    out["stages"] = stages;
    out["summary"] = plan.summary();
    out["table"] = plan.table();
    return out;
  }

  void cancel() {
    const std::lock_guard lock(mutex_);
    for (std::atomic<bool>* r : running_) *r = true;
  }
  std::vector<std::string> take_warnings() { return open()->take_warnings(); }
  void close() {
    std::shared_ptr<Session> last = std::move(session_);
    const Unlocked free;
    last.reset();
  }
  bool is_closed() const { return !session_; }

 private:
  class Running {
   public:
    Running(SessionHandle& session, std::atomic<bool>& cancelled) : session_(session), cancelled_(&cancelled) {
      const std::lock_guard lock(session_.mutex_);
      session_.running_.insert(cancelled_);
    }
    ~Running() {
      const std::lock_guard lock(session_.mutex_);
      session_.running_.erase(cancelled_);
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

   private:
    SessionHandle& session_;
    std::atomic<bool>* cancelled_;
  };

  std::shared_ptr<Session> open() const {
    if (!session_) throw Error("the session is closed");
    return session_;
  }

  std::shared_ptr<Session> session_;  ///< guarded by the GIL
  std::mutex mutex_;
  std::set<std::atomic<bool>*> running_;  ///< guarded by mutex_
};

}  // namespace

void bind_sessions(py::module_& module) {
  py::class_<SessionHandle>(module, "Session")
      .def(py::init<std::filesystem::path, bool, int, uint64_t, bool>())
      .def("run", &SessionHandle::run)
      .def("plan", &SessionHandle::plan)
      .def("cancel", &SessionHandle::cancel)
      .def("take_warnings", &SessionHandle::take_warnings)
      .def("close", &SessionHandle::close)
      .def_property_readonly("closed", &SessionHandle::is_closed);
}

}  // namespace terrazzo::python
