#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runner/editor/previews/picture_store.h"
#include "tests/run_node.h"
#include "tests/runner/editor/served_editor.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* secret = "nobody may read this";
constexpr const char* small_graph_text =
    R"({"terrazzo": 1, "nodes": {"grey": {"type": "solid", "size": 32, "value": [0.5, 0.5, 0.5]}}})";

/// Short times, so that tests do not wait long.
// What has to happen gets this long on a busy machine.
constexpr std::chrono::milliseconds long_time = std::chrono::seconds(30);

constexpr HttpLimits quick{.headers = std::chrono::milliseconds(600),
                           .body = std::chrono::milliseconds(900),
                           .write = std::chrono::milliseconds(900)};

/// Nothing of the document or the machine is in an answer that refuses.
void check_refused(const RawAnswer& answer, int status) {
  CHECK(answer.status == status);
  CHECK(!contains(answer.body, "terrazzo\":"));
  CHECK(!contains(answer.body, secret));
  CHECK(!answer.headers.contains("set-cookie"));
}

bool still_serves(const ServedEditor& editor) {
  return editor.ask(editor.get("/")).status == 200 && editor.ask(editor.post("state", "{}")).status == 200;
}

std::string request_with(const std::string& method, const std::string& path, const std::string& headers,
                         const std::string& body = "") {
  std::string out = method + " " + path + " HTTP/1.1\r\n" + headers;
  if (method == "POST") out += fmt::format("Content-Type: application/json\r\nContent-Length: {}\r\n", body.size());
  return out + "\r\n" + body;
}

}  // namespace

TEST_CASE("the editor's page and its calls are served to the browser that opened the address") {
  const TemporaryFolder folder;
  const ServedEditor editor(folder.path(), small_graph_text);
  const RawAnswer page = editor.ask(editor.get("/"));
  CHECK(page.status == 200);
  CHECK(contains(page.body, "<!doctype html>"));
  CHECK(page.headers.at("content-type") == "text/html; charset=utf-8");
  CHECK(contains(page.headers.at("content-security-policy"), "default-src 'none'; script-src 'self'"));
  CHECK(page.headers.at("x-content-type-options") == "nosniff");
  CHECK(page.headers.at("referrer-policy") == "no-referrer");
  CHECK(!page.headers.contains("access-control-allow-origin"));
  CHECK(editor.ask(editor.get("/app.js")).status == 200);
  CHECK(editor.call("state", Json::object()).at("text") == small_graph_text);
  // By the other name of this machine.
  const std::string named = fmt::format("Host: localhost:{0}\r\nOrigin: http://localhost:{0}\r\nCookie: {1}\r\n",
                                        editor.port(), editor.cookie);
  CHECK(editor.ask(request_with("POST", "/api/state", named, "{}")).status == 200);
}

TEST_CASE("the editor's address works once, and its cookie is out of reach of scripts and other sites") {
  const TemporaryFolder folder;
  const ServedEditor editor(folder.path(), small_graph_text);
  const std::string address = editor.server.address();
  const std::string path = address.substr(address.find("/open"));
  check_refused(editor.ask(request_with("GET", path, editor.host())), 403);
  check_refused(editor.ask(request_with("GET", "/open?token=", editor.host())), 403);
  check_refused(editor.ask(request_with("GET", "/open?token=" + std::string(64, 'a'), editor.host())), 403);
  // The browser that has the cookie may come again.
  CHECK(editor.ask(editor.get(path)).status == 303);

  const TemporaryFolder other_folder;
  const ServedEditor other(other_folder.path(), small_graph_text);
  const RawAnswer again = other.ask(request_with("GET", "/", other.host() + "Cookie: " + editor.cookie + "\r\n"));
  check_refused(again, 403);

  PlainDocument document(folder.path() / "graph.json", small_graph_text);
  Session session({.use_cache = false});
  const Sandbox sandbox(folder.path());
  const EditorServer fresh(document, session, sandbox, {});
  RawClient client(fresh.port());
  client.send(request_with("GET", fresh.address().substr(fresh.address().find("/open")),
                           fmt::format("Host: 127.0.0.1:{}\r\n", fresh.port())));
  const RawAnswer opened = client.answer();
  CHECK(opened.headers.at("location") == "/");
  const std::string cookie = opened.headers.at("set-cookie");
  CHECK(cookie.starts_with(fmt::format("terrazzo_{}=", fresh.port())));
  CHECK(cookie.ends_with("; HttpOnly; SameSite=Strict; Path=/"));
}

TEST_CASE("requests with a wrong Host, Origin or cookie get nothing") {
  const TemporaryFolder folder;
  const ServedEditor editor(folder.path(), small_graph_text);
  const std::string cookie = "Cookie: " + editor.cookie + "\r\n";
  const std::string host = editor.host();
  const std::string origin = fmt::format("Origin: http://127.0.0.1:{}\r\n", editor.port());
  for (const std::string& wrong :
       {std::string("Host: evil.example\r\n"), fmt::format("Host: evil.example:{}\r\n", editor.port()),
        std::string("Host: 127.0.0.1\r\n"), fmt::format("Host: 127.0.0.1:{}\r\n", editor.port() + 1),
        fmt::format("Host: 127.0.0.1:{}.evil.example\r\n", editor.port()), std::string(), host + host,
        host + "Host: evil.example\r\n", fmt::format("Host: [::1]:{}\r\n", editor.port())}) {
    INFO(wrong);
    check_refused(editor.ask(request_with("GET", "/", wrong + cookie)), 403);
    check_refused(editor.ask(request_with("GET", "/app.js", wrong + cookie)), 403);
    check_refused(editor.ask(request_with("POST", "/api/state", wrong + origin + cookie, "{}")), 403);
  }
  // Equal to Host does not help where both are another name.
  check_refused(editor.ask(request_with("POST", "/api/state",
                                        "Host: evil.example\r\nOrigin: http://evil.example\r\n" + cookie, "{}")),
                403);
  for (const std::string& wrong :
       {std::string(), std::string("Origin: null\r\n"), std::string("Origin: http://evil.example\r\n"),
        std::string("Origin: http://127.0.0.1\r\n"), fmt::format("Origin: https://127.0.0.1:{}\r\n", editor.port()),
        fmt::format("Origin: http://127.0.0.1:{}\r\n", editor.port() + 1),
        fmt::format("Origin: http://localhost:{}\r\n", editor.port()), origin + origin, origin + "Origin: null\r\n"}) {
    INFO(wrong);
    check_refused(editor.ask(request_with("POST", "/api/state", host + wrong + cookie, "{}")), 403);
    check_refused(editor.ask(request_with("POST", "/api/run", host + wrong + cookie, R"({"sinks": true})")), 403);
  }
  check_refused(editor.ask(request_with("GET", "/", host + "Origin: null\r\n" + cookie)), 403);
  for (const std::string& wrong : {std::string(), std::string("Cookie: terrazzo=1\r\n"),
                                   fmt::format("Cookie: terrazzo_{}={}\r\n", editor.port(), std::string(64, '0')),
                                   "Cookie: x" + editor.cookie + "\r\n", "Cookie: " + editor.cookie + "0\r\n"}) {
    INFO(wrong);
    for (const char* path : {"/", "/app.js", "/api/events?tab=a", "/picture/0123456789abcdef0123456789abcdef"})
      check_refused(editor.ask(request_with("GET", path, host + wrong)), 403);
    check_refused(editor.ask(request_with("POST", "/api/state", host + origin + wrong, "{}")), 403);
  }
  // A page at another port of this machine: the same site, whose requests bring the cookie.
  for (const char* site : {"same-site", "cross-site"})
    check_refused(
        editor.ask(request_with("GET", "/api/events?tab=a", host + cookie + "Sec-Fetch-Site: " + site + "\r\n")), 403);
  for (const char* method : {"OPTIONS", "PUT", "DELETE", "PATCH", "HEAD", "TRACE", "CONNECT", "QUERY"}) {
    const RawAnswer answer = editor.ask(request_with(method, "/", editor.own_headers()));
    CHECK(answer.status != 200);
    CHECK(!answer.headers.contains("access-control-allow-origin"));
  }
  CHECK(still_serves(editor));
}

TEST_CASE("no path of a request leads to a file") {
  const TemporaryFolder folder, outside;
  write_text(folder.path() / "kept.txt", secret);
  write_text(outside.path() / "secret.png", secret);
  fs::create_directory_symlink(outside.path(), folder.path() / "link");
  fs::create_directory(folder.path() / "inside");
  const ServedEditor editor(folder.path(), small_graph_text);
  for (const char* path :
       {"/kept.txt", "/graph.json", "/../../../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/..%2f..%2fetc%2fpasswd",
        "//etc/passwd", "/picture/../../kept.txt", "/picture/..%2f..%2fkept.txt", "/picture/%2fetc%2fpasswd",
        "/picture/", "/app.js/../kept.txt", "/app.js%00.html", "/api/state", "/runner/editor/web/dist/app.js"}) {
    INFO(path);
    const RawAnswer answer = editor.ask(editor.get(path));
    CHECK(answer.status == 404);
    CHECK(!contains(answer.body, secret));
    CHECK(!contains(answer.body, "root:"));
  }
  const auto refused = [&](const std::string& name, const Json& request) {
    const RawAnswer answer = editor.ask(editor.post(name, request.dump()));
    INFO(request.dump());
    CHECK(answer.status == 400);
    CHECK(!contains(answer.body, "secret.png"));
  };
  for (const char* place : {"/", "/etc", "..", "inside/../..", "link", "link/..", "inside/../link", "no such folder"})
    refused("files", {{"folder", place}});
  const Json listed = editor.call("files", {{"folder", ""}});
  CHECK(listed.at("entries").dump() ==
        R"([{"name":"inside","kind":"folder"},{"name":"graph.json","kind":"file"},{"name":"kept.txt","kind":"file"}])");
  CHECK(editor.call("files", {{"folder", "inside"}}).at("entries").empty());

  const std::string png = "iVBORw0KGgoAAAA=";  // only its beginning is looked at
  for (const char* name :
       {"../a.png", "/tmp/a.png", "inside/a.png", "link/a.png", ".a.png", "a.json", "a", "", "a\\b.png"})
    refused("save_picture", {{"name", name}, {"png", png}});
  refused("save_picture", {{"name", "a.png"}, {"png", "not base64"}});
  refused("save_picture", {{"name", "a.png"}, {"png", "AAAA"}});
  fs::create_symlink(outside.path() / "made.png", folder.path() / "a.png");
  fs::create_symlink(outside.path() / "secret.png", folder.path() / "b.png");
  refused("save_picture", {{"name", "a.png"}, {"png", png}});
  refused("save_picture", {{"name", "b.png"}, {"png", png}});
  CHECK(!fs::exists(outside.path() / "made.png"));
  CHECK(read_text(outside.path() / "secret.png") == secret);
  CHECK(editor.call("save_picture", {{"name", "mask 1.png"}, {"png", png}}).at("path") == "mask 1.png");
  CHECK(read_text(folder.path() / "mask 1.png").starts_with("\x89PNG"));
  CHECK(still_serves(editor));
}

TEST_CASE("bodies that are too large, compressed or without a length are refused before they are read") {
  const TemporaryFolder folder;
  const ServedEditor editor(folder.path(), small_graph_text);
  const auto post = [&](const std::string& path, const std::string& headers) {
    return editor.ask("POST " + path + " HTTP/1.1\r\n" + editor.own_headers() + headers + "\r\n");
  };
  const std::string json = "Content-Type: application/json\r\n";
  check_refused(post("/api/state", json + "Content-Length: 17000000\r\n"), 413);
  check_refused(post("/api/save_picture", json + "Content-Length: 70000000\r\n"), 413);
  check_refused(post("/api/state", json + "Content-Length: 99999999999999999999\r\n"), 411);
  check_refused(post("/api/state", json + "Content-Length: -1\r\n"), 411);
  check_refused(post("/api/state", json + "Content-Length: 2\r\nContent-Length: 3\r\n"), 411);
  check_refused(post("/api/state", json), 411);
  check_refused(post("/api/state", json + "Transfer-Encoding: chunked\r\n"), 411);
  check_refused(post("/api/state", json + "Content-Encoding: gzip\r\nContent-Length: 2\r\n"), 411);
  check_refused(post("/api/state", "Content-Type: text/plain\r\nContent-Length: 2\r\n"), 415);
  check_refused(post("/api/state", "Content-Type: multipart/form-data; boundary=x\r\nContent-Length: 2\r\n"), 415);
  CHECK(post("/api/state", json + "Expect: 100-continue\r\nContent-Length: 2\r\n").status == 417);
  CHECK(editor.ask(editor.post("state", "[]")).status == 400);
  CHECK(editor.ask(editor.post("state", "{")).status == 400);
  CHECK(editor.ask(editor.post("state", std::string(100'000, '['))).status == 400);
  CHECK(editor.ask(editor.post("nothing", "{}")).status == 404);
  // The rest of a refused request is not taken for another one.
  RawClient client(editor.port());
  client.send("POST /api/state HTTP/1.1\r\nHost: evil.example\r\nContent-Length: 500\r\n\r\n" + editor.get("/"));
  CHECK(client.answer().status == 403);
  CHECK(client.answer(std::chrono::seconds(2)).status == 0);
  // Headers without end.
  RawClient talker(editor.port());
  talker.send("GET / HTTP/1.1\r\n" + editor.own_headers());
  bool is_taken = true;
  for (int i = 0; is_taken && i < 10'000; i++)
    is_taken = talker.send(fmt::format("X-{}: {}\r\n", i, std::string(100, 'x')));
  CHECK(talker.answer().status == 400);
  CHECK(talker.is_closed_within(long_time));
  CHECK(still_serves(editor));
}

TEST_CASE("slow clients are cut off, and hold up nobody") {
  const TemporaryFolder folder;
  const ServedEditor editor(folder.path(), small_graph_text, quick);
  std::vector<std::unique_ptr<RawClient>> slow;
  const auto add = [&](const std::string& begun) {
    slow.push_back(std::make_unique<RawClient>(editor.port()));
    slow.back()->send(begun);
  };
  for (int i = 0; i < 20; i++) {
    add("");
    add("GET / HTTP/1.1\r\nHost: 127");
    add("POST /api/state HTTP/1.1\r\n" + editor.own_headers() +
        "Content-Type: application/json\r\nContent-Length: 1000000\r\n\r\n{");
  }
  CHECK(still_serves(editor));
  // A byte now and then does not help.
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(3);
  while (std::chrono::steady_clock::now() < end) {
    for (const auto& client : slow) client->send("x");
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  for (const auto& client : slow) CHECK(client->is_closed_within(long_time));
  CHECK(still_serves(editor));
}

TEST_CASE("two hundred event streams: some are served, none blocks the others") {
  const TemporaryFolder folder;
  const ServedEditor editor(folder.path(), small_graph_text);
  std::vector<std::unique_ptr<RawClient>> clients;
  int served = 0, refused = 0;
  for (int i = 0; i < 200; i++) {
    clients.push_back(std::make_unique<RawClient>(editor.port()));
    REQUIRE(clients.back()->is_connected());
    clients.back()->send(editor.get(fmt::format("/api/events?tab=tab-{}", i)));
    const int status = clients.back()->answer().status;
    (status == 200 ? served : refused) += status == 200 || status == 503;
  }
  CHECK(served == int(EventStreams::most_streams));
  CHECK(served + refused == 200);
  CHECK(editor.server.streams() == EventStreams::most_streams);
  CHECK(still_serves(editor));
  CHECK(contains(clients[0]->read_until("event: state", long_time), "event: state"));
  // A tab that connects again replaces its own stream, however full it is.
  RawClient again(editor.port());
  again.send(editor.get("/api/events?tab=tab-0"));
  CHECK(again.answer().status == 200);
  CHECK(clients[0]->is_closed_within(long_time));
  // Clients that have gone make room.
  clients.clear();
  const auto until = std::chrono::steady_clock::now() + long_time;
  while (editor.server.streams() > 1 && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  CHECK(editor.server.streams() == 1);
  RawClient next(editor.port());
  next.send(editor.get("/api/events?tab=another"));
  CHECK(next.answer().status == 200);
  for (const char* tab :
       {"", "a%20b", "a%0d%0ab", "0123456789012345678901234567890123456789012345678901234567890123456789"})
    CHECK(editor.ask(editor.get(std::string("/api/events?tab=") + tab)).status == 400);
  CHECK(still_serves(editor));
}

TEST_CASE("more connections than threads are turned away, and the server stops while they are open") {
  const TemporaryFolder folder;
  auto editor = std::make_unique<ServedEditor>(folder.path(), small_graph_text, HttpLimits{.connections = 8});
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 8; i++) {
    clients.push_back(std::make_unique<RawClient>(editor->port()));
    clients.back()->send(editor->get(fmt::format("/api/events?tab=tab-{}", i)));
    CHECK(clients.back()->answer().status == 200);
  }
  CHECK(editor->ask(editor->get("/")).status == 503);
  CHECK(contains(clients[0]->read_until("event: state", long_time), "event: state"));
  const int port = editor->port();
  editor.reset();
  for (const auto& client : clients) CHECK(contains(client->read_until("bye", long_time), "event: bye"));
  CHECK(!RawClient(port).is_connected());
}

TEST_CASE("a read-only editor changes and writes nothing") {
  const TemporaryFolder folder;
  ServedEditor editor(folder.path(), small_graph_text);
  editor.document.read_only = true;
  for (const char* name : {"edit", "undo", "redo", "format", "resolve", "save_picture"})
    CHECK(editor.ask(editor.post(name, R"({"name": "a.png", "png": "iVBORw0KGgoAAAA="})")).status == 400);
  CHECK(editor.ask(editor.post("run", R"({"sinks": true})")).status == 400);
  CHECK(!fs::exists(folder.path() / "a.png"));
  CHECK(editor.call("state", Json::object()).at("text") == small_graph_text);
}
