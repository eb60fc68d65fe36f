#pragma once

#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "graphs/values/variations.h"
#include "runner/editor/previews/grace.h"
#include "runner/editor/previews/previews.h"

namespace terrazzo {

/// The contact sheet of a sweep: what a node gives with each of several values, one after another, in small pictures.
/// One sheet at a time; a change of the document ends it. Runs no sink. Thread-safe.
///
/// Events: `sweep_picture` {id, cell, url, width, height, coarse}, `sweep_failed` {id, cell, message}, and at the end
/// `swept` {id, cancelled}. First all cells get what can be shown soon, then each its true picture.
class Sweeps {
 public:
  Sweeps(Session& session, const Sandbox& sandbox, PictureStore& store, PublishEvent publish);
  /// Cancels, and waits for the end.
  ~Sweeps();
  Sweeps(const Sweeps&) = delete;
  Sweeps& operator=(const Sweeps&) = delete;

  /// Starts a sheet, and cancels the one before. {id, level, node, map?, side?, sweeps: ["seed=1..8"]}, spelled as for
  /// `run --sweep`. Answers {"cells": [{"label", "values": {name: text}}]}. Throws Error.
  nlohmann::ordered_json start(const nlohmann::ordered_json& request, const std::string& text,
                               const std::filesystem::path& file);
  void cancel();
  bool wait_until_idle(std::chrono::milliseconds most) const;

 private:
  struct Sheet {
    std::string id, text;
    std::filesystem::path file;
    Wish wish{};
    std::vector<Variation> cells{};
  };
  void loop();
  void make(const Sheet& sheet);
  /// Whether the cell's true picture is shown.
  bool make_cell(const Sheet& sheet, size_t cell, bool in_haste);
  void publish_of_cell(const std::string& event, nlohmann::ordered_json data);

  Session& session_;
  const Sandbox& sandbox_;
  PublishEvent publish_;
  PictureBoard board_;
  Previews previews_;
  GracePeriod time_;

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::optional<Sheet> next_;
  bool runs_ = false, stops_ = false;
  std::atomic<bool> cancelled_{false};
  std::string id_;   // of the sheet that is being made; used by its thread, and those it starts
  size_t cell_ = 0;  // likewise
  std::thread thread_;
};

}  // namespace terrazzo
