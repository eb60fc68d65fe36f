#include "runner/editor/events.h"

#include <algorithm>

namespace terrazzo {

namespace {

/// What may wait for a tab that does not read.
constexpr size_t most_waiting_events = 2000;
constexpr size_t most_waiting_bytes = 64 << 20;
constexpr std::chrono::milliseconds longest_goodbye{400};

}  // namespace

struct EventStreams::Stream {
  struct Event {
    std::string kind, text;
    bool only_last_counts = false;
  };
  std::string tab;
  std::deque<Event> waiting;
  size_t bytes = 0;
  bool ends = false;    // once all that waits is sent
  bool is_cut = false;  // at once
  std::chrono::steady_clock::time_point last_sent = std::chrono::steady_clock::now();
};

/// Removes the stream once the server lets go of its function.
struct EventStreams::Registration {
  EventStreams* owner;
  std::shared_ptr<Stream> stream;
  Registration(EventStreams* o, std::shared_ptr<Stream> s) : owner(o), stream(std::move(s)) {}
  Registration(const Registration&) = delete;
  Registration& operator=(const Registration&) = delete;
  ~Registration() { owner->remove(stream); }
};

EventStreams::EventStreams(std::function<void(const std::string&)> left) : left_(std::move(left)) {}

std::string EventStreams::formatted(const std::string& event, const std::string& data) {
  return "event: " + event + "\ndata: " + data + "\n\n";
}

HttpStream EventStreams::open(const std::string& tab, const std::function<std::string()>& first) {
  auto stream = std::make_shared<Stream>();
  stream->tab = tab;
  {
    const std::lock_guard lock(mutex_);
    if (is_closed_) return {};
    const auto same = std::ranges::find_if(streams_, [&](const auto& s) { return s->tab == tab && !s->is_cut; });
    if (same == streams_.end() && streams_.size() >= most_streams) return {};
    if (same != streams_.end()) (*same)->is_cut = true;
    streams_.push_back(stream);
  }
  changed_.notify_all();
  const auto registration = std::make_shared<Registration>(this, stream);
  std::string text = first();
  const std::lock_guard lock(mutex_);
  stream->waiting.push_front({"", std::move(text)});
  return [this, registration](std::chrono::milliseconds wait) { return next(*registration->stream, wait); };
}

std::optional<std::string> EventStreams::next(Stream& stream, std::chrono::milliseconds wait) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, wait, [&] { return stream.is_cut || stream.ends || !stream.waiting.empty(); });
  if (stream.is_cut || (stream.ends && stream.waiting.empty())) return std::nullopt;
  const auto now = std::chrono::steady_clock::now();
  std::string out;
  for (; !stream.waiting.empty(); stream.waiting.pop_front()) out += stream.waiting.front().text;
  stream.bytes = 0;
  if (out.empty() && now - stream.last_sent >= heartbeat) out = ": still here\n\n";
  if (!out.empty()) stream.last_sent = now;
  return out;
}

void EventStreams::publish(const std::string& event, const std::string& data, bool only_last_counts) {
  const std::string text = formatted(event, data);
  {
    const std::lock_guard lock(mutex_);
    for (const std::shared_ptr<Stream>& s : streams_) {
      if (s->is_cut) continue;
      if (only_last_counts)
        std::erase_if(s->waiting, [&](const Stream::Event& e) {
          const bool replaced = e.only_last_counts && e.kind == event;
          if (replaced) s->bytes -= e.text.size();
          return replaced;
        });
      s->waiting.push_back({event, text, only_last_counts});
      s->bytes += text.size();
      s->is_cut = s->waiting.size() > most_waiting_events || s->bytes > most_waiting_bytes;
    }
  }
  changed_.notify_all();
}

void EventStreams::close() {
  publish("bye", "{}");
  {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    for (const std::shared_ptr<Stream>& s : streams_) s->ends = true;
  }
  changed_.notify_all();
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, longest_goodbye, [&] { return streams_.empty(); });
}

size_t EventStreams::count() const {
  const std::lock_guard lock(mutex_);
  return streams_.size();
}

void EventStreams::remove(const std::shared_ptr<Stream>& stream) {
  bool has_left = false;
  {
    const std::lock_guard lock(mutex_);
    streams_.remove(stream);
    has_left = std::ranges::none_of(streams_, [&](const auto& s) { return s->tab == stream->tab; });
  }
  changed_.notify_all();
  if (has_left && left_) left_(stream->tab);
}

}  // namespace terrazzo
