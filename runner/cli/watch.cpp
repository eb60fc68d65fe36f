#include "runner/cli/watch.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace terrazzo {

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

bool Watch::wait_for_change(const std::atomic<bool>& cancelled) {
  const auto changed = [&] {
    return std::any_of(seen_.begin(), seen_.end(), [](const auto& s) { return look(s.first) != s.second; });
  };
  while (!changed()) {
    // In short naps, so that cancelling is noticed soon.
    for (int i = 0; i < 10; i++) {
      if (cancelled) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
  return true;
}

}  // namespace terrazzo
