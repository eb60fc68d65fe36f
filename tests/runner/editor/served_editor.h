#pragma once

#include <filesystem>
#include <mutex>
#include <string>

#include <nlohmann/json.hpp>

#include "runner/editor/server.h"
#include "tests/runner/editor/raw_client.h"

namespace terrazzo::test {

/// A document that is only a text; an edit {"edits": [{"op": "text", "text"}]} replaces it.
class PlainDocument : public DocumentAccess {
 public:
  PlainDocument(std::filesystem::path file, std::string text) : file_(std::move(file)), text_(std::move(text)) {}

  int64_t revision() const override;
  std::string text() const override;
  std::filesystem::path file() const override { return file_; }
  bool is_read_only() const override { return read_only; }
  Json state(const RunFindings& findings) const override;
  Json edit(const Json& request) override;
  Json undo() override;
  Json redo() override { return undo(); }
  Json format() override { return undo(); }
  Json resolve(const Json&) override { return undo(); }
  Json copy(const Json&) const override;
  Json diff() const override;
  Json preset(const Json&) const override;
  Json types() const override;
  bool look_at_disk() override { return false; }

  bool read_only = false;

 private:
  mutable std::mutex mutex_;
  std::filesystem::path file_;
  std::string text_;
  int64_t revision_ = 1;
};

/// An editor of a graph in a folder, with a browser that has opened it.
class ServedEditor {
 public:
  /// `text`: of the graph file `folder`/graph.json, which is written.
  ServedEditor(const std::filesystem::path& folder, const std::string& text, const HttpLimits& limits = {});

  int port() const { return server.port(); }
  std::string host() const;
  /// The headers of the page's own requests.
  std::string own_headers() const;
  std::string get(const std::string& path) const;
  std::string post(const std::string& name, const std::string& body) const;
  /// Sends a request over a connection of its own.
  RawAnswer ask(const std::string& request) const;
  /// The JSON that a call gives; its status must be 200.
  nlohmann::ordered_json call(const std::string& name, const nlohmann::ordered_json& request) const;

  PlainDocument document;
  Session session;
  Sandbox sandbox;
  EditorServer server;
  std::string cookie;  ///< "terrazzo_PORT=..."
};

}  // namespace terrazzo::test
