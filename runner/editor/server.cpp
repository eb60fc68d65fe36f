#include "runner/editor/server.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "runner/editor/web_files.h"

namespace terrazzo {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::chrono::milliseconds between_looks_at_disk{500};
constexpr const char* json_type = "application/json";
constexpr size_t longest_tab_id = 64;
constexpr std::string_view picture_path = "/picture/";
constexpr std::string_view call_path = "/api/";

std::string dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

HttpAnswer json_answer(int status, const Json& body) {
  return {.status = status, .type = json_type, .body = dumped(body), .headers = {{"Cache-Control", "no-store"}}};
}

HttpAnswer not_found() {
  return {.status = 404, .body = "there is nothing\n"};
}

bool is_tab_id(const std::string& text) {
  return !text.empty() && text.size() <= longest_tab_id && std::ranges::all_of(text, [](char c) {
    return c == '-' || c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  });
}

}  // namespace

EditorServer::EditorServer(DocumentAccess& document, Session& session, const Sandbox& sandbox, const Options& options)
    : document_(document), sandbox_(sandbox), folders_(options.folders), events_([this](const std::string& tab) {
        if (runs_) runs_->forget(tab);
      }) {
  folders_.insert(folders_.begin(), document.file().parent_path());
  runs_ = std::make_unique<Runs>(
      session, sandbox, pictures_,
      [this](const std::string& event, const Json& data, bool only_last) {
        events_.publish(event, dumped(data), only_last);
      },
      [this] { tell_state(); });
  text_ = document.text();
  runs_->changed(text_, document.file());
  add_calls();
  server_ = serve_http(options.port, *this, options.limits);
  gate_.open(server_->port());
  watcher_ = std::thread([this] { watch_disk(); });
}

EditorServer::~EditorServer() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  stopping_.notify_all();
  events_.close();
  runs_->cancel();
  watcher_.join();
  // Then the members go: first the server, then the runs, which may tell of their findings until the end.
}

std::optional<HttpAnswer> EditorServer::refuse(const HttpRequest& head) {
  if (std::optional<HttpAnswer> no = gate_.refuse(head)) return no;
  const bool is_known = head.method == "POST"
                            ? head.path.starts_with(call_path) && calls_.contains(head.path.substr(call_path.size()))
                            : head.path == "/open" || head.path == "/api/events" || find_web_file(head.path) ||
                                  head.path.starts_with(picture_path);
  if (is_known) return std::nullopt;
  HttpAnswer out = not_found();
  add_safe_headers(out);
  return out;
}

HttpAnswer EditorServer::answer(const HttpRequest& request) {
  HttpAnswer out;
  try {
    out = request.method == "POST" ? post(request) : get(request);
  } catch (const std::exception& e) {
    out = json_answer(500, {{"error", e.what()}});
  }
  add_safe_headers(out);
  return out;
}

HttpAnswer EditorServer::get(const HttpRequest& request) {
  if (request.path == "/open") return gate_.exchange(request);
  if (request.path == "/api/events") return open_events(request);
  if (const WebFile* file = find_web_file(request.path))
    return {
        .type = std::string(file->type), .body = std::string(file->text), .headers = {{"Cache-Control", "no-cache"}}};
  if (request.path.starts_with(picture_path))
    if (const PictureStore::FilePtr file = pictures_.find(request.path.substr(picture_path.size())))
      return {.type = file->type,
              .body = std::string(file->bytes.begin(), file->bytes.end()),
              .headers = {{"Cache-Control", "private, max-age=86400, immutable"}}};
  return not_found();
}

HttpAnswer EditorServer::open_events(const HttpRequest& request) {
  const std::string tab = request.queried("tab");
  if (!is_tab_id(tab)) return {.status = 400, .body = "expected the id of a tab\n"};
  HttpAnswer out{.type = "text/event-stream", .headers = {{"Cache-Control", "no-store"}}};
  out.stream = events_.open(tab, [&] {
    Json state;
    within(sandbox_, [&] { state = document_.state(runs_->findings()); });
    std::string first = "retry: 1000\n\n" + EventStreams::formatted("state", dumped(state));
    for (const std::string& picture : runs_->current_pictures()) first += EventStreams::formatted("picture", picture);
    return first;
  });
  if (!out.stream) return {.status = 503, .body = "too many tabs are open\n"};
  return out;
}

HttpAnswer EditorServer::post(const HttpRequest& request) {
  const Json body = Json::parse(request.body, nullptr, false);
  if (!body.is_object()) return json_answer(400, {{"error", "expected a JSON object"}});
  try {
    return json_answer(200, calls_.at(request.path.substr(call_path.size()))(body));
  } catch (const EditConflict& e) {
    return json_answer(409, {{"error", e.what()}, {"pointer", e.about()}});
  } catch (const Error& e) {
    Json answer = {{"error", e.what()}};
    if (e.about().starts_with('/')) answer["pointer"] = e.about();
    return json_answer(400, answer);
  } catch (const Json::exception& e) {
    return json_answer(400, {{"error", std::string("the request has not the expected form: ") + e.what()}});
  }
}

EditorServer::Call EditorServer::editing(Call call) {
  return [this, call = std::move(call)](const Json& request) {
    if (document_.is_read_only()) throw Error("the graph is shown read-only");
    Json out = call(request);
    tell_state();
    return out;
  };
}

void EditorServer::tell_state() {
  const std::lock_guard lock(telling_);
  std::string text = document_.text();
  if (text != text_) {
    text_ = text;
    runs_->changed(std::move(text), document_.file());
  }
  Json state;
  within(sandbox_, [&] { state = document_.state(runs_->findings()); });
  events_.publish("state", dumped(state), true);
}

void EditorServer::watch_disk() {
  std::unique_lock lock(mutex_);
  while (!stopping_.wait_for(lock, between_looks_at_disk, [&] { return stops_; })) {
    lock.unlock();
    try {
      const bool has_changed = document_.look_at_disk();
      if (runs_->look_at_files() || has_changed) tell_state();
    } catch (const std::exception&) {
      // The document says what is wrong with its file in its state.
    }
    lock.lock();
  }
}

}  // namespace terrazzo
