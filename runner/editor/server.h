#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <nlohmann/json_fwd.hpp>

#include "runner/api/session.h"
#include "runner/editor/document.h"
#include "runner/editor/document_access.h"
#include "runner/editor/events.h"
#include "runner/editor/gate.h"
#include "runner/editor/http.h"
#include "runner/editor/previews/picture_store.h"
#include "runner/editor/previews/runs.h"
#include "runner/engine/sandbox.h"

namespace terrazzo {

/// The server of the graph editor: lets its own page in (see Gate), and answers it. The protocol is JSON:
///
/// | request                | answer                                                                         |
/// |------------------------|--------------------------------------------------------------------------------|
/// | GET /open?token=T      | the cookie, once, and on to /                                                  |
/// | GET /                  | the page; also /app.js and /app.css                                            |
/// | GET /picture/DIGEST    | a picture that a run has made known                                            |
/// | GET /api/events?tab=ID | server-sent events                                                             |
/// | POST /api/NAME         | 200 {...}, or 4xx {"error": message, "pointer"?: JSON pointer}                 |
class EditorServer final : private HttpHandler {
 public:
  struct Options {
    int port = 0;                                  ///< 0: a free one
    std::vector<std::filesystem::path> folders{};  ///< that may be listed, besides the graph's
    HttpLimits limits{};
  };
  /// Borrows everything; starts to serve. Throws Error.
  EditorServer(DocumentAccess& document, Session& session, const Sandbox& sandbox, const Options& options);
  /// Says goodbye to the tabs and cancels what runs.
  ~EditorServer() override;
  EditorServer(const EditorServer&) = delete;
  EditorServer& operator=(const EditorServer&) = delete;

  /// What to open in a browser; works once.
  std::string address() const { return gate_.address(); }
  int port() const { return server_->port(); }
  size_t streams() const { return events_.count(); }
  Runs& runs() { return *runs_; }

 private:
  using Json = nlohmann::ordered_json;
  using Call = std::function<Json(const Json& request)>;

  std::optional<HttpAnswer> refuse(const HttpRequest& head) override;
  HttpAnswer answer(const HttpRequest& request) override;
  HttpAnswer get(const HttpRequest& request);
  HttpAnswer post(const HttpRequest& request);
  HttpAnswer open_events(const HttpRequest& request);
  void add_calls();
  /// An edit: refused for readers, and told to all tabs.
  Call editing(Call call);
  void tell_state();
  void watch_disk();
  Json files_in(const Json& request) const;
  Json save_picture(const Json& request) const;
  Json pixels_of(const Json& request);
  Json piece_of(const Json& request);
  Json histogram_of_picture(const Json& request);
  Json start_run(const Json& request);

  DocumentAccess& document_;
  const Sandbox& sandbox_;
  std::vector<std::filesystem::path> folders_;
  Gate gate_;
  EventStreams events_;
  PictureStore pictures_;
  std::map<std::string, Call> calls_;
  std::mutex telling_;  // states are sent in order
  std::string text_;    // as the runs have it
  std::mutex mutex_;
  std::condition_variable stopping_;
  bool stops_ = false;
  std::thread watcher_;
  std::unique_ptr<Runs> runs_;
  std::unique_ptr<HttpServer> server_;
};

}  // namespace terrazzo
