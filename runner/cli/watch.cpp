#include "runner/cli/watch.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace terrazzo {

namespace {

constexpr std::chrono::milliseconds pause(100);  // between two looks

}  // namespace

Watch::Look Watch::look(const std::filesystem::path& path) {
  std::error_code missing;
  Look out;
  out.time = std::filesystem::last_write_time(path, missing);
  if (missing) return {};
  out.size = std::filesystem::is_regular_file(path, missing) ? std::filesystem::file_size(path, missing) : 0;
  return out;
}

void Watch::look_at(const Graph& graph) {
  seen_.clear();
  const auto add = [&](const std::filesystem::path& path) { seen_.emplace(path, look(path)); };
  if (!graph.file.empty()) add(graph.file);
  for (const std::filesystem::path& path : graph.made_from) add(path);
  for (const GraphNode& n : graph.nodes) {
    if (!n.type->files_read) continue;
    for (const std::filesystem::path& file : n.type->files_read(n.params)) {
      add(file);
      // A new file in a folder changes the folder's time.
      for (const auto& [name, value] : n.params)
        if (n.type->find_param(name)->type == ParamType::path && file.parent_path() == std::get<std::string>(value))
          add(file.parent_path());
    }
  }
}

void Watch::look_again() {
  for (auto& [path, seen] : seen_) seen = look(path);
}

bool Watch::has_changed() const {
  return std::any_of(seen_.begin(), seen_.end(), [](const auto& s) { return look(s.first) != s.second; });
}

bool Watch::wait_for_change(const std::atomic<bool>& cancelled) const {
  while (!has_changed()) {
    if (cancelled) return false;
    std::this_thread::sleep_for(pause);
  }
  return true;
}

void Watch::until_change(const std::atomic<bool>& cancelled,
                         const std::function<void(const std::atomic<bool>& stop)>& work) const {
  std::atomic<bool> stop = false;
  const std::jthread guard([&](const std::stop_token& over) {
    std::mutex mutex;
    std::condition_variable_any ended;
    std::unique_lock lock(mutex);
    do {
      if (cancelled || has_changed()) stop = true;
    } while (!stop && !ended.wait_for(lock, over, pause, [&] { return over.stop_requested(); }));
  });
  work(stop);
}

}  // namespace terrazzo
