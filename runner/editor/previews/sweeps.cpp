#include "runner/editor/previews/sweeps.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace terrazzo {

namespace {

using Json = nlohmann::ordered_json;

constexpr size_t most_cells = 64;
constexpr int least_cell_side = 64, usual_cell_side = 256, greatest_cell_side = 1024;
// For the first look at all cells: as long as coarse levels of usual sizes take.
constexpr std::chrono::milliseconds longest_haste{1500}, longest_haste_shown{250};

}  // namespace

Sweeps::Sweeps(Session& session, const Sandbox& sandbox, PictureStore& store, PublishEvent publish)
    : session_(session),
      sandbox_(sandbox),
      publish_(std::move(publish)),
      board_(store, [this](const std::string& event, const Json& data, bool) { publish_of_cell(event, data); }),
      previews_(session, sandbox, board_,
                [this](const std::string& event, const Json& data, bool) { publish_of_cell(event, data); }),
      time_(longest_haste, longest_haste_shown) {
  thread_ = std::thread([this] { loop(); });
}

Sweeps::~Sweeps() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = cancelled_ = true;
    next_.reset();
    time_.cancel();
  }
  changed_.notify_all();
  thread_.join();
}

Json Sweeps::start(const Json& request, const std::string& text, const std::filesystem::path& file) {
  Sheet sheet{.id = request.at("id").get<std::string>(), .text = text, .file = file};
  sheet.wish.at = {request.value("level", ""), request.at("node").get<std::string>()};
  sheet.wish.map = request.value("map", "");
  sheet.wish.side = std::clamp(request.value("side", usual_cell_side), least_cell_side, greatest_cell_side);
  sheet.cells = swept(request.at("sweeps").get<std::vector<std::string>>());
  if (sheet.cells.empty()) throw Error("a sweep needs values, such as seed=1..8");
  if (sheet.cells.size() > most_cells)
    throw Error(fmt::format("these are {} pictures; a sheet has {} at most", sheet.cells.size(), most_cells));
  // Mistakes in names and values are told now.
  load_variation(text, file, sheet.cells.front().overrides(), sandbox_);
  Json cells = Json::array();
  for (const Variation& v : sheet.cells) {
    Json values = Json::object();
    for (const auto& [name, value] : v.values) values[name] = value;
    cells.push_back({{"label", v.label()}, {"values", std::move(values)}});
  }
  {
    const std::lock_guard lock(mutex_);
    next_ = std::move(sheet);
    cancelled_ = true;
    time_.cancel();
  }
  changed_.notify_all();
  return {{"cells", std::move(cells)}};
}

void Sweeps::cancel() {
  {
    const std::lock_guard lock(mutex_);
    next_.reset();
    cancelled_ = true;
    time_.cancel();
  }
  changed_.notify_all();
}

bool Sweeps::wait_until_idle(std::chrono::milliseconds most) const {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, most, [&] { return !next_ && !runs_; });
}

void Sweeps::loop() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return stops_ || next_; });
    if (stops_) return;
    const Sheet sheet = *std::exchange(next_, std::nullopt);
    cancelled_ = false;
    runs_ = true;
    id_ = sheet.id;
    lock.unlock();
    make(sheet);
    publish_("swept", {{"id", sheet.id}, {"cancelled", cancelled_.load()}}, false);
    lock.lock();
    runs_ = false;
    changed_.notify_all();
  }
}

void Sweeps::make(const Sheet& sheet) {
  std::vector<bool> is_done(sheet.cells.size());
  for (const bool in_haste : {true, false})
    for (size_t i = 0; i < sheet.cells.size() && !cancelled_; i++)
      if (!is_done[i]) is_done[i] = make_cell(sheet, i, in_haste);
}

bool Sweeps::make_cell(const Sheet& sheet, size_t cell, bool in_haste) {
  {
    const std::lock_guard lock(mutex_);
    if (cancelled_) return true;
    time_.begin();
    time_.set_stale(in_haste);
  }
  cell_ = cell;
  board_.retain({});
  try {
    const EditedGraph graph = load_variation(sheet.text, sheet.file, sheet.cells[cell].overrides(), sandbox_);
    const PreviewTargets targets = previews_.targets_of(graph, sheet.text, {sheet.wish});
    if (targets.ready.empty() && targets.slow.empty())
      throw Error(fmt::format("\"{}\" has no picture", sheet.wish.at.node));
    previews_.show_ready(graph, targets.ready, time_.cancelled());
    if (!targets.slow.empty()) previews_.make(graph, targets.slow, time_);
    return true;
  } catch (const Cancelled&) {
    return false;
  } catch (const std::exception& e) {
    publish_("sweep_failed", {{"id", sheet.id}, {"cell", cell}, {"message", e.what()}}, false);
    return true;
  }
}

void Sweeps::publish_of_cell(const std::string& event, Json data) {
  const bool has_failed = event == "failed";
  if (!has_failed && event != "picture") return;
  data["id"] = id_;
  data["cell"] = cell_;
  publish_(has_failed ? "sweep_failed" : "sweep_picture", data, false);
}

}  // namespace terrazzo
