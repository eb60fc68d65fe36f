#include "tests/runner/editor/raw_client.h"

#include <algorithm>
#include <cctype>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace terrazzo::test {

RawClient::RawClient(int port) {
  socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(uint16_t(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof(to)) == 0) return;
  ::close(socket_);
  socket_ = -1;
}

RawClient::~RawClient() {
  if (socket_ >= 0) ::close(socket_);
}

bool RawClient::send(const std::string& bytes) {
  for (size_t sent = 0; sent < bytes.size();) {
    const ssize_t now = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (now <= 0) return false;
    sent += size_t(now);
  }
  return true;
}

bool RawClient::read_more(std::chrono::steady_clock::time_point until) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
  pollfd waits{socket_, POLLIN, 0};
  if (is_closed_ || left.count() <= 0 || ::poll(&waits, 1, int(left.count())) <= 0) return false;
  char bytes[1 << 14];
  const ssize_t got = ::recv(socket_, bytes, sizeof(bytes), 0);
  is_closed_ = got <= 0;
  if (got > 0) received_.append(bytes, size_t(got));
  return got > 0;
}

std::string RawClient::read_until(const std::string& text, std::chrono::milliseconds most) {
  const auto until = std::chrono::steady_clock::now() + most;
  while (received_.find(text) == std::string::npos && read_more(until)) {
  }
  const size_t at = received_.find(text);
  const size_t length = at == std::string::npos ? received_.size() : at + text.size();
  std::string out = received_.substr(0, length);
  received_.erase(0, length);
  return out;
}

RawAnswer RawClient::answer(std::chrono::milliseconds most) {
  const auto until = std::chrono::steady_clock::now() + most;
  RawAnswer out;
  const std::string head = read_until("\r\n\r\n", most);
  if (!head.starts_with("HTTP/1.1 ")) {
    out.is_closed = is_closed_;
    return out;
  }
  out.status = std::stoi(head.substr(9, 3));
  for (size_t at = head.find("\r\n") + 2; at < head.size();) {
    const size_t end = head.find("\r\n", at), colon = head.find(": ", at);
    if (end == std::string::npos || end == at) break;
    std::string name = head.substr(at, colon - at);
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    out.headers[name] = head.substr(colon + 2, end - colon - 2);
    at = end + 2;
  }
  const auto length = out.headers.find("content-length");
  const size_t bytes = length == out.headers.end() ? 0 : std::stoul(length->second);
  while (received_.size() < bytes && read_more(until)) {
  }
  out.body = received_.substr(0, bytes);
  received_.erase(0, bytes);
  out.is_closed = is_closed_;
  return out;
}

bool RawClient::is_closed_within(std::chrono::milliseconds most) {
  const auto until = std::chrono::steady_clock::now() + most;
  while (read_more(until)) {
  }
  return is_closed_;
}

}  // namespace terrazzo::test
