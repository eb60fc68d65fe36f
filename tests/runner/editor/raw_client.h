#pragma once

#include <chrono>
#include <map>
#include <string>

namespace terrazzo::test {

/// What a server has sent.
struct RawAnswer {
  int status = 0;                                ///< 0: it closed the connection without an answer
  std::map<std::string, std::string> headers{};  ///< names in lower case
  std::string body{};
  bool is_closed = false;  ///< the server has closed the connection
};

/// A connection to 127.0.0.1 that sends any bytes: what browsers would never send.
class RawClient {
 public:
  explicit RawClient(int port);
  ~RawClient();
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  bool is_connected() const { return socket_ >= 0; }
  /// Whether all was taken.
  bool send(const std::string& bytes);
  /// Everything that comes until the text has come, the connection is closed, or the time is over.
  std::string read_until(const std::string& text, std::chrono::milliseconds most);
  /// An answer with its whole body, as far as its length is known.
  RawAnswer answer(std::chrono::milliseconds most = std::chrono::seconds(10));
  /// Whether the server closes the connection within the time.
  bool is_closed_within(std::chrono::milliseconds most);

 private:
  int socket_ = -1;
  std::string received_;
  bool is_closed_ = false;
  bool read_more(std::chrono::steady_clock::time_point until);
};

}  // namespace terrazzo::test
