#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "runner/editor/http.h"

namespace terrazzo {

/// The streams of server-sent events, one per tab of the browser. Each holds a thread of the server: their number is
/// limited, and what waits to be sent to one, too. Thread-safe.
class EventStreams {
 public:
  static constexpr size_t most_streams = 32;
  static constexpr std::chrono::seconds heartbeat{10};

  /// `left` is called with a tab's id once its last stream has ended; from any thread.
  explicit EventStreams(std::function<void(const std::string& tab)> left = {});

  /// A stream for a tab, which begins with what `first` returns, whole events; an older stream of the same tab ends.
  /// Events from then on are not lost: what is published while `first` is called comes after it. Empty if there are too
  /// many, or once closed; `first` is not called then.
  HttpStream open(const std::string& tab, const std::function<std::string()>& first);

  /// Sends an event to all tabs. Of the events of a kind of which only the last one counts, one that a tab has not got
  /// yet is replaced. Tabs that do not take their events are cut off; their page connects again.
  void publish(const std::string& event, const std::string& data, bool only_last_counts = false);

  /// Sends the event "bye", and lets all streams end after that; waits for them for less than half a second.
  void close();
  size_t count() const;

  /// An event as it is sent. `data` must be one line, as JSON without layout is.
  static std::string formatted(const std::string& event, const std::string& data);

 private:
  struct Stream;
  struct Registration;
  std::optional<std::string> next(Stream& stream, std::chrono::milliseconds wait);
  void remove(const std::shared_ptr<Stream>& stream);

  std::function<void(const std::string&)> left_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::list<std::shared_ptr<Stream>> streams_;
  bool is_closed_ = false;
};

}  // namespace terrazzo
