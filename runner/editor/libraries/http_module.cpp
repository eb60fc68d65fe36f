#include <condition_variable>
#include <deque>
#include <mutex>
#include <set>
#include <thread>

#include <fmt/format.h>
#include <httplib.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include "runner/editor/http.h"
#include "runner/editor/libraries/http_connection.h"

namespace terrazzo {

namespace {

constexpr int backlog = 128;
/// Requests answered over one connection.
constexpr int most_requests = 1000;
/// How long streams and answers have to end by themselves when the server stops.
constexpr std::chrono::milliseconds grace{300};

/// The connection that this thread serves: handlers get no stream from cpp-httplib.
thread_local HttpConnection* served = nullptr;
/// No thread is free for the connection.
thread_local bool is_crowded = false;

/// A thread for each connection, made when there is none free. Beyond the limit, the job runs at once on the accepting
/// thread with is_crowded set.
class ConnectionThreads final : public httplib::TaskQueue {
 public:
  explicit ConnectionThreads(size_t most) : most_(most) {}

  void enqueue(std::function<void()> job) override {
    {
      const std::lock_guard lock(mutex_);
      if (jobs_.size() < free_ || threads_.size() < most_) {
        if (jobs_.size() >= free_) {
          threads_.emplace_back([this] { work(); });
          free_++;
        }
        jobs_.push_back(std::move(job));
        changed_.notify_one();
        return;
      }
    }
    is_crowded = true;
    job();
    is_crowded = false;
  }

  void shutdown() override {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    for (std::thread& t : threads_) t.join();
  }

 private:
  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [&] { return ends_ || !jobs_.empty(); });
      if (jobs_.empty()) return;
      const std::function<void()> job = std::move(jobs_.front());
      jobs_.pop_front();
      free_--;
      lock.unlock();
      job();
      lock.lock();
      free_++;
    }
  }

  const size_t most_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> jobs_;
  std::deque<std::thread> threads_;
  size_t free_ = 0;  // threads that wait, or soon will
  bool ends_ = false;
};

HttpRequest request_of(const httplib::Request& from) {
  HttpRequest out{.method = from.method, .path = from.path};
  for (const auto& [name, value] : from.params) out.query.try_emplace(name, value);
  for (const auto& [name, value] : from.headers) {
    std::string lower = name;
    for (char& c : lower)
      if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    // These it adds itself.
    if (lower != "remote_addr" && lower != "remote_port" && lower != "local_addr" && lower != "local_port")
      out.headers.emplace(std::move(lower), value);
  }
  out.body = from.body;
  return out;
}

void fill(httplib::Response& out, HttpAnswer answer) {
  out.status = answer.status;
  constexpr int first_failure = 400;
  if (answer.status >= first_failure) {
    served->close_after_answer();
    out.set_header("Connection", "close");
  }
  for (const auto& [name, value] : answer.headers) out.set_header(name, value);
  if (!answer.stream) return out.set_content(answer.body, answer.type);
  HttpConnection* const connection = served;
  connection->close_after_answer();
  out.set_header("Connection", "close");
  out.set_content_provider(answer.type,
                           [connection, stream = std::move(answer.stream)](size_t, httplib::DataSink& sink) {
                             const std::optional<std::string> next = stream(std::chrono::milliseconds(250));
                             if (!next || connection->is_gone()) return false;
                             return next->empty() || sink.write(next->data(), next->size());
                           });
}

class Server final : public HttpServer, private httplib::Server {
 public:
  Server(int port, HttpHandler& handler, const HttpLimits& limits) : handler_(handler), limits_(limits) {
    new_task_queue = [this] { return new ConnectionThreads(size_t(limits_.connections)); };
    // Its own options would let other programs listen at the same port, and take requests with their cookies.
    set_socket_options([](socket_t socket) {
      const int on = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    });
    set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      std::optional<HttpAnswer> refusal = handler_.refuse(request_of(request));
      if (!refusal) {
        served->begin_body();
        return HandlerResponse::Unhandled;
      }
      fill(response, std::move(*refusal));
      return HandlerResponse::Handled;
    });
    const auto respond = [this](const httplib::Request& request, httplib::Response& response) {
      fill(response, handler_.answer(request_of(request)));
    };
    Get(".*", respond);
    Post(".*", respond);
    // The body would come before anything has been checked.
    set_expect_100_continue_handler([](const httplib::Request&, httplib::Response&) {
      served->close_after_answer();
      return 417;
    });
    port_ = port;
    if (port == 0) port_ = bind_to_any_port("127.0.0.1");
    if (port == 0 ? port_ <= 0 : !bind_to_port("127.0.0.1", port))
      throw terrazzo::Error(port == 0 ? "cannot listen at 127.0.0.1"
                                      : fmt::format("cannot listen at port {}: another program may do so", port));
    // It waits with five connections; browsers open more at once.
    ::listen(svr_sock_, backlog);
    accepting_ = std::thread([this] { listen_after_bind(); });
    while (!is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  ~Server() override {
    stopping_ = true;
    stop();
    const auto until = std::chrono::steady_clock::now() + grace;
    std::unique_lock lock(mutex_);
    none_open_.wait_until(lock, until, [&] { return open_.empty(); });
    for (const socket_t socket : open_) ::shutdown(socket, SHUT_RDWR);
    lock.unlock();
    accepting_.join();
  }

  int port() const override { return port_; }

 private:
  bool process_and_close_socket(socket_t socket) override {
    is_crowded ? turn_away(socket) : serve(socket);
    return true;
  }

  static void turn_away(socket_t socket) {
    constexpr std::string_view answer =
        "HTTP/1.1 503 Service Unavailable\r\nConnection: close\r\nContent-Length: 0\r\n\r\n";
    [[maybe_unused]] const ssize_t ignored = ::send(socket, answer.data(), answer.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    ::shutdown(socket, SHUT_RDWR);
    ::close(socket);
  }

  void serve(socket_t socket) {
    const int on = 1;
    ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
    {
      const std::lock_guard lock(mutex_);
      open_.insert(socket);
    }
    {
      HttpConnection connection(socket, limits_, stopping_);
      served = &connection;
      for (int i = 1; i <= most_requests && !connection.is_last() && connection.await_request(patience(i)); i++) {
        bool closed = false;
        const auto prepare = [](httplib::Request& request) {
          // It would compress what never leaves this machine, slowly, and send parts that nobody needs.
          request.headers.erase("Accept-Encoding");
          request.ranges.clear();
        };
        if (!process_request(connection, i == most_requests, closed, prepare) || closed) break;
      }
      served = nullptr;
    }
    linger(socket);
    const std::lock_guard lock(mutex_);
    open_.erase(socket);
    ::close(socket);
    if (open_.empty()) none_open_.notify_all();
  }

  /// How long a client may take to begin its request number `i`. Where threads are scarce, none waits for another one.
  std::chrono::milliseconds patience(int i) {
    constexpr std::chrono::milliseconds scarce{100};
    const std::lock_guard lock(mutex_);
    return i > 1 && int(open_.size()) > limits_.connections / 2 ? std::min(scarce, limits_.headers) : limits_.headers;
  }

  /// Closing a socket with unread bytes resets it, and the client may lose the answer: takes what has arrived first.
  static void linger(socket_t socket) {
    ::shutdown(socket, SHUT_WR);
    char rest[16 << 10];
    for (int i = 0; i < 64; i++)
      if (::recv(socket, rest, sizeof(rest), MSG_DONTWAIT) <= 0) break;
  }

  HttpHandler& handler_;
  const HttpLimits limits_;
  int port_ = 0;
  std::atomic<bool> stopping_{false};
  std::thread accepting_;
  std::mutex mutex_;
  std::condition_variable none_open_;
  std::set<socket_t> open_;
};

std::unique_ptr<HttpServer> serve(int port, HttpHandler& handler, const HttpLimits& limits) {
  return std::make_unique<Server>(port, handler, limits);
}

}  // namespace

}  // namespace terrazzo

extern "C" __attribute__((visibility("default"))) const terrazzo::HttpLibrary* terrazzo_http_library() {
  static const terrazzo::HttpLibrary library{&terrazzo::serve};
  return &library;
}
