#include "runner/editor/libraries/http_connection.h"

#include <algorithm>
#include <cstring>

#include <poll.h>
#include <sys/socket.h>

namespace terrazzo {

namespace {

/// How often a wait looks whether the server stops.
constexpr std::chrono::milliseconds wait_slice{100};

}  // namespace

HttpConnection::HttpConnection(socket_t socket, const HttpLimits& limits, const std::atomic<bool>& stopping)
    : socket_(socket), limits_(limits), stopping_(stopping) {}

bool HttpConnection::wait_for(short events, Clock::time_point until) const {
  // What is being sent may go out: when the server stops, its sockets are shut down soon.
  while (!stopping_ || events == POLLOUT) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
    if (left.count() <= 0) return false;
    pollfd socket{socket_, events, 0};
    const int ready = ::poll(&socket, 1, int(std::min(left, wait_slice).count()));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
  return false;
}

bool HttpConnection::await_request(std::chrono::milliseconds most) {
  in_headers_ = true;
  header_bytes_ = 0;
  deadline_ = Clock::now() + most;
  if (begin_ == end_ && !wait_for(POLLIN, deadline_)) return false;
  char byte = 0;
  if (begin_ == end_ && ::recv(socket_, &byte, 1, MSG_PEEK) <= 0) return false;
  deadline_ = Clock::now() + limits_.headers;
  return true;
}

void HttpConnection::begin_body() {
  in_headers_ = false;
  deadline_ = Clock::now() + limits_.body;
}

bool HttpConnection::is_gone() const {
  pollfd socket{socket_, POLLRDHUP, 0};
  return ::poll(&socket, 1, 0) > 0;
}

bool HttpConnection::is_readable() const {
  return begin_ < end_ || wait_for(POLLIN, deadline_);
}

bool HttpConnection::is_writable() const {
  return wait_for(POLLOUT, Clock::now() + limits_.write) && !is_gone();
}

ssize_t HttpConnection::read(char* out, size_t size) {
  if (begin_ == end_) {
    if (!wait_for(POLLIN, deadline_)) return -1;
    const ssize_t got = ::recv(socket_, buffer_, sizeof(buffer_), 0);
    if (got <= 0) return got;
    begin_ = 0;
    end_ = size_t(got);
  }
  const size_t taken = std::min(size, end_ - begin_);
  if (in_headers_ && (header_bytes_ += taken) > limits_.header_bytes) return -1;
  std::memcpy(out, buffer_ + begin_, taken);
  begin_ += taken;
  return ssize_t(taken);
}

ssize_t HttpConnection::write(const char* bytes, size_t size) {
  size_t sent = 0;
  while (sent < size) {
    if (!wait_for(POLLOUT, Clock::now() + limits_.write)) return -1;
    const ssize_t now = ::send(socket_, bytes + sent, size - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (now > 0)
      sent += size_t(now);
    else if (now == 0 || (errno != EAGAIN && errno != EINTR))
      return -1;
  }
  return ssize_t(sent);
}

void HttpConnection::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip = "127.0.0.1";
  port = 0;
}

void HttpConnection::get_local_ip_and_port(std::string& ip, int& port) const {
  ip = "127.0.0.1";
  port = 0;
}

}  // namespace terrazzo
