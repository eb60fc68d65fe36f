#pragma once

#include <atomic>
#include <string>

#include <httplib.h>

#include "runner/editor/http.h"

namespace terrazzo {

/// A client's connection. cpp-httplib waits so long for every byte and reads header lines of any number and length;
/// here a whole request has deadlines, and its headers a size. Used by one thread.
class HttpConnection final : public httplib::Stream {
 public:
  /// Borrows the socket. `stopping` makes every wait end.
  HttpConnection(socket_t socket, const HttpLimits& limits, const std::atomic<bool>& stopping);

  /// Waits for a request to begin; false if the client has gone or takes too long.
  bool await_request(std::chrono::milliseconds most);
  /// The headers have been read: from now on the body's deadline counts.
  void begin_body();
  /// What of the request has not been read would be taken for the next one: no more are read.
  void close_after_answer() { last_ = true; }
  bool is_last() const { return last_; }
  /// Whether the client has closed its end, which ends a stream.
  bool is_gone() const;
  bool is_stopping() const { return stopping_; }

  bool is_readable() const override;
  bool is_writable() const override;
  ssize_t read(char* out, size_t size) override;
  ssize_t write(const char* bytes, size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;
  /// Waits for one of poll's events.
  bool wait_for(short events, Clock::time_point until) const;

  const socket_t socket_;
  const HttpLimits& limits_;
  const std::atomic<bool>& stopping_;
  char buffer_[16 << 10];
  size_t begin_ = 0, end_ = 0;
  size_t header_bytes_ = 0;
  bool in_headers_ = true, last_ = false;
  Clock::time_point deadline_;
};

}  // namespace terrazzo
