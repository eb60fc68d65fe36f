#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>

#include "runner/editor/http.h"

namespace terrazzo {

/// Decides which requests reach the editor: those of its own page, opened with the address that was printed. Other
/// pages in the same browser, pages whose host name was rebound to this machine, and other users' programs get nothing.
/// Thread-safe.
class Gate {
 public:
  /// Makes a token and a cookie from the system's random numbers. Throws Error if there are none.
  Gate();

  /// Once the port is known; nothing is let in before.
  void open(int port);
  /// The address that lets a browser in, once: "http://127.0.0.1:PORT/open?token=...".
  std::string address() const;

  /// The answer to a request that must not be served, judged by its headers alone; nullopt to let it in.
  std::optional<HttpAnswer> refuse(const HttpRequest& request) const;
  /// Exchanges the token for the cookie. A browser that has the cookie may come again.
  HttpAnswer exchange(const HttpRequest& request);

 private:
  bool has_cookie(const HttpRequest& request) const;
  std::string host() const;
  /// Names the port: cookies of all ports are in one jar.
  std::string cookie_name() const;

  std::atomic<int> port_{0};
  std::string token_, cookie_;
  bool is_used_ = false;
  std::mutex mutex_;
};

/// The headers of every answer.
void add_safe_headers(HttpAnswer& answer);

/// The greatest body of a request for `path`, in bytes.
size_t greatest_body(const std::string& path);

}  // namespace terrazzo
