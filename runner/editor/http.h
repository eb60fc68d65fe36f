#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"

/// An HTTP server for this machine. cpp-httplib parses and writes messages; it is in a module that is loaded on demand,
/// since it brings libraries that no other command needs.
namespace terrazzo {

struct HttpRequest {
  std::string method;                                 ///< "GET"
  std::string path;                                   ///< without the query, percent-decoded
  std::map<std::string, std::string> query{};         ///< the first value of each name, decoded
  std::multimap<std::string, std::string> headers{};  ///< names in lower case
  std::string body{};                                 ///< empty while HttpHandler::refuse is asked

  /// The header's value; nullopt unless it is given exactly once.
  std::optional<std::string> header(const std::string& name) const;
  /// A query's value, or an empty text.
  std::string queried(const std::string& name) const;
};

/// The body of an answer that goes on: each call gives what is to be sent next, an empty text if nothing came up within
/// the time, or nullopt at its end.
using HttpStream = std::function<std::optional<std::string>(std::chrono::milliseconds)>;

struct HttpAnswer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body{};
  std::vector<std::pair<std::string, std::string>> headers{};
  HttpStream stream{};  ///< instead of the body, if set; destroyed once the client has gone
};

/// Answers requests; called from many threads. Must not throw.
class HttpHandler {
 public:
  virtual ~HttpHandler() = default;
  /// Looks at a request before its body is read. If it gives an answer, that is sent, and the connection closed.
  virtual std::optional<HttpAnswer> refuse(const HttpRequest& head) = 0;
  virtual HttpAnswer answer(const HttpRequest& request) = 0;
};

struct HttpLimits {
  int connections = 96;                      ///< at once; each has a thread. More get 503
  size_t header_bytes = 32 << 10;            ///< of the request line and all headers together
  std::chrono::milliseconds headers{5'000};  ///< for all of them to arrive, and for a next request to begin
  std::chrono::milliseconds body{30'000};    ///< for the whole body to arrive
  std::chrono::milliseconds write{10'000};   ///< for a client to take more of an answer
};

/// Serves until it is destroyed, which takes at most half a second: whatever is still being answered is cut off.
class HttpServer {
 public:
  virtual ~HttpServer() = default;
  virtual int port() const = 0;
};

/// Listens at 127.0.0.1 only; port 0: a free one. `handler` must outlive the server. Throws Error.
std::unique_ptr<HttpServer> serve_http(int port, HttpHandler& handler, const HttpLimits& limits = {});

/// What the module gives.
struct HttpLibrary {
  std::unique_ptr<HttpServer> (*serve)(int port, HttpHandler& handler, const HttpLimits& limits);
};

}  // namespace terrazzo
