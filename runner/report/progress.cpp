#include "runner/report/progress.h"

#include <algorithm>
#include <mutex>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/printable.h"
#include "core/base/text.h"
#include "graphs/text/problem.h"
#include "runner/report/process_usage.h"

namespace terrazzo {

namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

/// Limits events to one per interval and key.
class Throttle {
 public:
  explicit Throttle(std::chrono::milliseconds interval) : interval_(interval) {}
  bool open(const Stage* key) {
    const Clock::time_point now = Clock::now();
    const auto [at, fresh] = last_.try_emplace(key, now);
    if (!fresh && now - at->second < interval_) return false;
    at->second = now;
    return true;
  }
  /// Counts from now for this key.
  void start(const Stage* key) { last_[key] = Clock::now(); }

 private:
  std::chrono::milliseconds interval_;
  std::map<const Stage*, Clock::time_point> last_;
};

/// The fraction of work done, with stages weighted by their expected time. Not thread-safe.
class WorkDone {
 public:
  void plan(const Plan& plan) {
    began_ = Clock::now();
    for (const Stage& s : plan.stages)
      if (s.needed) all_ += weight(s);
  }
  void progress(const Stage& s, double fraction) { done_[&s] = std::max(done_[&s], fraction); }
  void settle(const Stage& s) { done_[&s] = 1; }

  double fraction() const {
    double done = 0;
    for (const auto& [stage, fraction] : done_) done += weight(*stage) * fraction;
    return all_ > 0 ? std::min(1.0, done / all_) : 1;
  }

  /// "about 12 s left"; empty while there is too little information, and near the end.
  std::string left() const {
    const double elapsed = std::chrono::duration<double>(Clock::now() - began_).count(), done = fraction();
    const double left = elapsed * (1 - done) / std::max(done, 1e-9);
    if (elapsed < 2 || done < 0.05 || left < 2) return "";
    if (left < 90) return fmt::format("about {:.0f} s left", left);
    return fmt::format("about {:.0f} min left", left / 60);
  }

 private:
  /// The weight of stages that are only looked up: small but not zero.
  static double weight(const Stage& s) { return std::max(s.expected_seconds, 0.02); }

  double all_ = 0;
  Clock::time_point began_ = Clock::now();
  std::map<const Stage*, double> done_;
};

/// The number of settled stages: run, reused, or found not to be needed. A stage whose stored result turns out damaged
/// is computed later and counts once.
class StageCount {
 public:
  void plan(const Plan& plan) { all_ = plan.needed(); }
  void settle(const Stage& s) { settled_.insert(&s); }
  int settled() const { return static_cast<int>(settled_.size()); }
  int all() const { return all_; }

 private:
  int all_ = 0;
  std::set<const Stage*> settled_;
};

void write_event(std::ostream& out, const Json& event) {
  out << event.dump(-1, ' ', false, Json::error_handler_t::replace) << std::endl;
}

void write_note(std::ostream& out, const Stage& s, const std::string& message) {
  out << fmt::format("note: node \"{}\": {}", s.node->name, message) << std::endl;
}

class NoProgress : public Progress {
 public:
  explicit NoProgress(std::ostream& out) : out_(out) {}
  void warned(const std::string& message) override { write_warning(ProgressMode::none, out_, message); }
  void closed(const RunResult&) override {}

 private:
  std::ostream& out_;
};

class JsonProgress : public Progress {
 public:
  explicit JsonProgress(std::ostream& out) : out_(out) {}
  void planned(const Plan& plan) override {
    Json stages = Json::array();
    for (const Stage& s : plan.stages) {
      Json stage = {{"node", s.node->name}, {"type", s.type().name}, {"state", name_of(s.state)}};
      stage["key"] = s.known ? Json(s.known->key.hex()) : Json();
      stage["why"] = s.reason;
      if (s.shape.size) stage["size"] = {s.shape.size->width, s.shape.size->height};
      if (s.shape.channels) stage["channels"] = *s.shape.channels;
      stages.push_back(std::move(stage));
    }
    write({{"event", "plan"}, {"stages", std::move(stages)}});
  }
  void started(const Stage& s) override { write({{"event", "start"}, {"node", s.node->name}}); }
  void waits(const Stage& s) override { write({{"event", "wait"}, {"node", s.node->name}}); }
  void progressed(const Stage& s, double fraction) override {
    {
      const std::lock_guard lock(mutex_);
      if (!throttle_.open(&s)) return;
    }
    write({{"event", "progress"}, {"node", s.node->name}, {"fraction", fraction}});
  }
  void noted(const Stage& s, const std::string& message) override {
    const bool warning = is_warning(message);
    write({{"event", warning ? "warning" : "note"},
           {"node", s.node->name},
           {"message", warning ? message.substr(warning_mark.size()) : message}});
  }
  void finished(const Stage& s, double seconds) override {
    write({{"event", "done"}, {"node", s.node->name}, {"seconds", seconds}});
  }
  void reused(const Stage& s) override { write({{"event", "cached"}, {"node", s.node->name}}); }
  void failed(const Stage& s, const std::string& message) override {
    write({{"event", "failed"}, {"node", s.node->name}, {"message", message}});
  }
  void skipped(const Stage& s, const std::string& because) override {
    write({{"event", "skipped"}, {"node", s.node->name}, {"because", because}});
  }
  void warned(const std::string& message) override {
    const std::lock_guard lock(mutex_);
    write_warning(ProgressMode::json, out_, message);
  }
  void closed(const RunResult& r) override {
    using Kind = StageOutcome::Kind;
    const ProcessUsage usage = process_usage();
    Json files = Json::array();
    for (const StageOutcome& s : r.stages)
      for (const OutputFile& f : s.files) files.push_back(f.path.string());
    write({{"event", "finished"},
           {"ok", r.ok()},
           {"cancelled", r.cancelled},
           {"seconds", r.seconds},
           {"cpu_seconds", usage.cpu_seconds},
           {"peak_memory", usage.peak_memory},
           {"cached", r.count(Kind::reused)},
           {"run", r.count(Kind::run)},
           {"failed", r.count(Kind::failed)},
           {"skipped", r.count(Kind::skipped)},
           {"unfinished", r.count(Kind::unfinished)},
           {"files", std::move(files)}});
  }

 private:
  void write(const Json& event) {
    const std::lock_guard lock(mutex_);
    write_event(out_, event);
  }
  std::ostream& out_;
  std::mutex mutex_;
  Throttle throttle_{std::chrono::milliseconds(100)};
};

class PlainProgress : public Progress {
 public:
  explicit PlainProgress(std::ostream& out) : out_(out) {}
  void planned(const Plan& plan) override { count_.plan(plan); }
  void started(const Stage& s) override {
    const std::lock_guard lock(mutex_);
    throttle_.start(&s);
  }
  void waits(const Stage& s) override {
    const std::lock_guard lock(mutex_);
    line(s, "is being made by another process");
  }
  void progressed(const Stage& s, double fraction) override {
    const std::lock_guard lock(mutex_);
    if (throttle_.open(&s)) line(s, fmt::format("{:.0f} %", 100 * fraction));
  }
  void noted(const Stage& s, const std::string& message) override {
    if (is_warning(message)) return;  // printed at the end
    const std::lock_guard lock(mutex_);
    write_note(out_, s, message);
  }
  void finished(const Stage& s, double seconds) override {
    const std::lock_guard lock(mutex_);
    count_.settle(s);
    line(s, fmt::format("{:.2f} s", seconds));
  }
  void reused(const Stage& s) override {
    const std::lock_guard lock(mutex_);
    count_.settle(s);
    line(s, s.type().is_sink() ? "up to date" : "cached");
  }
  void not_needed(const Stage& s) override {
    const std::lock_guard lock(mutex_);
    count_.settle(s);
  }
  void failed(const Stage& s, const std::string&) override {
    const std::lock_guard lock(mutex_);
    line(s, "failed");
  }
  void skipped(const Stage& s, const std::string& because) override {
    const std::lock_guard lock(mutex_);
    line(s, fmt::format("skipped, as {} failed", because));
  }
  void warned(const std::string& message) override {
    const std::lock_guard lock(mutex_);
    write_warning(ProgressMode::plain, out_, message);
  }
  void closed(const RunResult&) override {}

 private:
  void line(const Stage& s, const std::string& what) {
    out_ << printable(
                fmt::format("[{}/{}] {} ({}) {}", count_.settled(), count_.all(), s.node->name, s.type().name, what))
         << std::endl;
  }
  std::ostream& out_;
  std::mutex mutex_;
  StageCount count_;
  Throttle throttle_{std::chrono::milliseconds(5000)};
};

class BarProgress : public Progress {
 public:
  explicit BarProgress(std::ostream& out) : out_(out) {}
  ~BarProgress() override { erase(); }
  void planned(const Plan& plan) override {
    count_.plan(plan);
    work_.plan(plan);
  }
  void started(const Stage& s) override {
    const std::lock_guard lock(mutex_);
    running_[&s] = 0;
    draw(false);
  }
  void waits(const Stage& s) override { started(s); }
  void progressed(const Stage& s, double fraction) override {
    const std::lock_guard lock(mutex_);
    running_[&s] = fraction;
    work_.progress(s, fraction);
    draw(false);
  }
  void noted(const Stage& s, const std::string& message) override {
    if (is_warning(message)) return;  // printed at the end
    const std::lock_guard lock(mutex_);
    erase();
    write_note(out_, s, message);
    draw(true);
  }
  void finished(const Stage& s, double) override { settle(s); }
  void reused(const Stage& s) override { settle(s); }
  void not_needed(const Stage& s) override { settle(s); }
  void failed(const Stage& s, const std::string&) override {
    const std::lock_guard lock(mutex_);
    running_.erase(&s);
  }
  void warned(const std::string& message) override {
    const std::lock_guard lock(mutex_);
    erase();
    write_warning(ProgressMode::bar, out_, message);
  }
  void closed(const RunResult&) override {
    const std::lock_guard lock(mutex_);
    erase();
  }

 private:
  void settle(const Stage& s) {
    const std::lock_guard lock(mutex_);
    running_.erase(&s);
    count_.settle(s);
    work_.settle(s);
    draw(false);
  }
  void erase() {
    if (drawn_) out_ << "\r\x1b[K" << std::flush;
    drawn_ = false;
  }
  void draw(bool at_once) {
    if (!throttle_.open(nullptr) && !at_once) return;
    std::string names = work_.left();
    for (const auto& [stage, fraction] : running_)
      names += fmt::format("{}{} {:.0f} %", names.empty() ? "" : ", ", stage->node->name, 100 * fraction);
    constexpr int width = 24;
    const int filled = std::clamp(static_cast<int>(work_.fraction() * width), 0, width);
    constexpr size_t room = 44;  // keeps the line shorter than a terminal of 80 columns
    if (names.size() > room) names = names.substr(0, room - 3) + "...";
    out_ << fmt::format("\r\x1b[K[{:#<{}}{:.<{}}] {}/{}  {}", "", filled, "", width - filled, count_.settled(),
                        count_.all(), names)
         << std::flush;
    drawn_ = true;
  }
  std::ostream& out_;
  std::mutex mutex_;
  StageCount count_;
  WorkDone work_;
  bool drawn_ = false;
  std::map<const Stage*, double> running_;
  Throttle throttle_{std::chrono::milliseconds(80)};
};

}  // namespace

std::optional<ProgressMode> progress_mode_from(std::string_view name) {
  const auto at = std::find(progress_mode_names.begin(), progress_mode_names.end(), name);
  if (at == progress_mode_names.end()) return std::nullopt;
  return static_cast<ProgressMode>(at - progress_mode_names.begin());
}

void write_warning(ProgressMode mode, std::ostream& out, const std::string& message) {
  if (mode == ProgressMode::json)
    write_event(out, {{"event", "warning"}, {"message", message}});
  else
    out << "warning: " << printable(message) << std::endl;
}

namespace {

Json error_event(const std::string& file, const Problem& problem) {
  Json event = {{"event", "error"}};
  if (!file.empty() || !problem.file.empty()) event["file"] = problem.file.empty() ? file : problem.file;
  if (problem.place.line > 0) {
    event["line"] = problem.place.line;
    event["column"] = problem.place.column;
  }
  if (!problem.node.empty()) event["node"] = problem.node;
  event["message"] = describe("", {{}, problem.where, problem.message, ""});
  return event;
}

}  // namespace

void write_error(ProgressMode mode, std::ostream& out, const std::exception& error) {
  const GraphError* graph = dynamic_cast<const GraphError*>(&error);
  const std::string file = graph ? graph->file() : "";
  const std::vector<Problem> problems = graph ? graph->problems() : std::vector<Problem>{{{}, "", error.what()}};
  for (size_t i = 0; i < std::min(problems.size(), most_problems_shown); i++) {
    if (mode == ProgressMode::json)
      write_event(out, error_event(file, problems[i]));
    else
      out << "error: " << printable(describe(file, problems[i])) << std::endl;
  }
  const std::string more = problems_not_shown(problems.size());
  if (more.empty()) return;
  if (mode == ProgressMode::json)
    write_event(out, {{"event", "error"}, {"message", more}});
  else
    out << more << std::endl;
}

void write_watching(ProgressMode mode, std::ostream& out, size_t files) {
  if (mode == ProgressMode::none) return;
  if (mode == ProgressMode::json)
    write_event(out, {{"event", "watching"}, {"files", files}});
  else
    out << fmt::format("watching {}; Ctrl-C ends it", counted(int64_t(files), "file")) << std::endl;
}

std::unique_ptr<Progress> make_progress(ProgressMode mode, std::ostream& out, bool terminal) {
  if (mode == ProgressMode::automatic) mode = terminal ? ProgressMode::bar : ProgressMode::plain;
  switch (mode) {
    case ProgressMode::bar:
      return std::make_unique<BarProgress>(out);
    case ProgressMode::json:
      return std::make_unique<JsonProgress>(out);
    case ProgressMode::none:
      return std::make_unique<NoProgress>(out);
    default:
      return std::make_unique<PlainProgress>(out);
  }
}

}  // namespace terrazzo
