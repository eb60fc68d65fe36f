#include "tests/runner/editor/served_editor.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/texts.h"

namespace terrazzo::test {

using Json = nlohmann::ordered_json;

int64_t PlainDocument::revision() const {
  const std::lock_guard lock(mutex_);
  return revision_;
}

std::string PlainDocument::text() const {
  const std::lock_guard lock(mutex_);
  return text_;
}

Json PlainDocument::state(const RunFindings& findings) const {
  Json problems = Json::array();
  for (const Problem& p : findings.errors) problems.push_back({{"severity", "error"}, {"message", p.message}});
  return {{"revision", revision()}, {"text", text()}, {"problems", problems}};
}

Json PlainDocument::edit(const Json& request) {
  const std::lock_guard lock(mutex_);
  const Json& edit = request.at("edits").at(0);
  if (edit.at("op") != "text") throw Error("/nodes/x", "no such edit");
  text_ = edit.at("text").get<std::string>();
  return {{"revision", ++revision_}};
}

Json PlainDocument::undo() {
  return {{"revision", revision()}};
}

Json PlainDocument::copy(const Json&) const {
  return {{"text", "{}"}};
}

Json PlainDocument::diff() const {
  return {{"lines", Json::array()}, {"nodes", Json::object()}};
}

Json PlainDocument::preset(const Json&) const {
  return {{"values", Json::object()}};
}

Json PlainDocument::types() const {
  return {{"types", Json::array()}};
}

namespace {

std::filesystem::path written(const std::filesystem::path& folder, const std::string& text) {
  const std::filesystem::path file = folder / "graph.json";
  write_text(file, text);
  return file;
}

}  // namespace

ServedEditor::ServedEditor(const std::filesystem::path& folder, const std::string& text, const HttpLimits& limits)
    : document(written(folder, text), text),
      session({.cache = folder / ".cache", .threads = 2}),
      sandbox(folder),
      server(document, session, sandbox, {.limits = limits}) {
  const std::string address = server.address();
  const RawAnswer opened = ask("GET " + address.substr(address.find("/open")) + " HTTP/1.1\r\n" + host() + "\r\n");
  REQUIRE(opened.status == 303);
  const std::string given = opened.headers.at("set-cookie");
  cookie = given.substr(0, given.find(';'));
}

std::string ServedEditor::host() const {
  return fmt::format("Host: 127.0.0.1:{}\r\n", port());
}

std::string ServedEditor::own_headers() const {
  return fmt::format("{}Origin: http://127.0.0.1:{}\r\nCookie: other=1; {}\r\n", host(), port(), cookie);
}

std::string ServedEditor::get(const std::string& path) const {
  return fmt::format("GET {} HTTP/1.1\r\n{}\r\n", path, own_headers());
}

std::string ServedEditor::post(const std::string& name, const std::string& body) const {
  return fmt::format("POST /api/{} HTTP/1.1\r\n{}Content-Type: application/json\r\nContent-Length: {}\r\n\r\n{}", name,
                     own_headers(), body.size(), body);
}

RawAnswer ServedEditor::ask(const std::string& request) const {
  RawClient client(port());
  client.send(request);
  return client.answer();
}

Json ServedEditor::call(const std::string& name, const Json& request) const {
  const RawAnswer answer = ask(post(name, request.dump()));
  INFO(answer.body);
  REQUIRE(answer.status == 200);
  return Json::parse(answer.body);
}

}  // namespace terrazzo::test
