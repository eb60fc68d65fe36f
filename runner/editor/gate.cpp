#include "runner/editor/gate.h"

#include <cerrno>
#include <charconv>
#include <cstring>

#include <fmt/format.h>
#include <sys/random.h>

namespace terrazzo {

namespace {

constexpr size_t secret_bytes = 32;
constexpr size_t greatest_picture = 64 << 20, greatest_other = 16 << 20;

std::string secret() {
  unsigned char bytes[secret_bytes];
  if (::getrandom(bytes, sizeof(bytes), 0) != ssize_t(sizeof(bytes)))
    throw Error(fmt::format("the system gives no random numbers: {}", std::strerror(errno)));
  std::string out;
  for (const unsigned char b : bytes) out += fmt::format("{:02x}", b);
  return out;
}

/// Takes as long wherever they differ.
bool are_same(const std::string& secret, const std::string& given) {
  if (secret.size() != given.size()) return false;
  unsigned char difference = 0;
  for (size_t i = 0; i < secret.size(); i++) difference |= static_cast<unsigned char>(secret[i] ^ given[i]);
  return difference == 0;
}

HttpAnswer refusal(int status, const std::string& why) {
  HttpAnswer out{.status = status, .body = why + "\n"};
  add_safe_headers(out);
  return out;
}

std::optional<size_t> length_of(const HttpRequest& request) {
  const std::optional<std::string> text = request.header("content-length");
  size_t length = 0;
  if (!text || text->empty()) return std::nullopt;
  const auto [stop, error] = std::from_chars(text->data(), text->data() + text->size(), length);
  return error == std::errc() && stop == text->data() + text->size() ? std::optional(length) : std::nullopt;
}

bool is_json(const HttpRequest& request) {
  const std::string type = request.header("content-type").value_or("");
  return type.substr(0, type.find(';')) == "application/json";
}

/// Bodies of unknown length escape cpp-httplib's limit, and compressed ones may grow beyond it.
std::optional<HttpAnswer> refuse_body(const HttpRequest& request) {
  if (request.headers.contains("transfer-encoding") || request.headers.contains("content-encoding"))
    return refusal(411, "the body must be sent as it is, with its length");
  if (request.method == "GET") {
    if (request.headers.contains("content-length") && length_of(request) != size_t(0))
      return refusal(400, "GET takes no body");
    return std::nullopt;
  }
  const std::optional<size_t> length = length_of(request);
  if (!length) return refusal(411, "the body's length is missing");
  if (*length > greatest_body(request.path)) return refusal(413, "the body is too large");
  if (!is_json(request)) return refusal(415, "the body must be application/json");
  return std::nullopt;
}

}  // namespace

void add_safe_headers(HttpAnswer& answer) {
  const auto add = [&](const char* name, const char* value) { answer.headers.emplace_back(name, value); };
  add("Content-Security-Policy",
      "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' blob: data:; "
      "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  add("X-Content-Type-Options", "nosniff");
  add("X-Frame-Options", "DENY");
  add("Referrer-Policy", "no-referrer");
  add("Cross-Origin-Resource-Policy", "same-origin");
  add("Cross-Origin-Opener-Policy", "same-origin");
}

size_t greatest_body(const std::string& path) {
  return path == "/api/save_picture" ? greatest_picture : greatest_other;
}

Gate::Gate() : token_(secret()), cookie_(secret()) {}

void Gate::open(int port) {
  port_ = port;
}

std::string Gate::host() const {
  return fmt::format("127.0.0.1:{}", port_.load());
}

std::string Gate::address() const {
  return fmt::format("http://{}/open?token={}", host(), token_);
}

std::string Gate::cookie_name() const {
  return fmt::format("terrazzo_{}", port_.load());
}

bool Gate::has_cookie(const HttpRequest& request) const {
  const std::string wanted = cookie_name() + "=";
  const auto [first, last] = request.headers.equal_range("cookie");
  for (auto header = first; header != last; ++header) {
    std::string_view rest = header->second;
    while (!rest.empty()) {
      const std::string_view one = rest.substr(0, rest.find(';'));
      if (one.starts_with(wanted) && are_same(cookie_, std::string(one.substr(wanted.size())))) return true;
      rest.remove_prefix(std::min(rest.size(), one.size() + 1));
      while (rest.starts_with(' ')) rest.remove_prefix(1);
    }
  }
  return false;
}

std::optional<HttpAnswer> Gate::refuse(const HttpRequest& request) const {
  const std::string by_number = host(), by_name = fmt::format("localhost:{}", port_.load());
  const std::optional<std::string> given = request.header("host");
  if (port_ == 0 || !given || (*given != by_number && *given != by_name)) return refusal(403, "wrong Host");
  if (request.method != "GET" && request.method != "POST") return refusal(405, "only GET and POST are served");
  const bool has_origin = request.headers.contains("origin");
  if ((request.method == "POST" || has_origin) && request.header("origin") != "http://" + *given)
    return refusal(403, "wrong Origin");
  // Pages of other ports of this machine count as the same site, and their requests bring the cookie.
  const std::optional<std::string> site = request.header("sec-fetch-site");
  if (request.headers.contains("sec-fetch-site") && site != "same-origin" && site != "none")
    return refusal(403, "asked for by another page");
  if (request.headers.contains("range")) return refusal(400, "parts are not served");
  if (std::optional<HttpAnswer> body = refuse_body(request)) return body;
  if (request.path == "/open" && request.method == "GET") return std::nullopt;
  if (!has_cookie(request)) return refusal(403, "open the address that the program has printed");
  return std::nullopt;
}

HttpAnswer Gate::exchange(const HttpRequest& request) {
  const bool knows_token = are_same(token_, request.queried("token"));
  bool is_first = false;
  if (knows_token) {
    const std::lock_guard lock(mutex_);
    is_first = !std::exchange(is_used_, true);
  }
  if (!is_first && !has_cookie(request))
    return refusal(403, knows_token ? "this address was opened before, and works once; start the program anew"
                                    : "open the address that the program has printed");
  HttpAnswer out{.status = 303};
  out.headers = {{"Location", "/"}, {"Cache-Control", "no-store"}};
  if (is_first)
    out.headers.emplace_back("Set-Cookie",
                             fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/", cookie_name(), cookie_));
  return out;
}

}  // namespace terrazzo
