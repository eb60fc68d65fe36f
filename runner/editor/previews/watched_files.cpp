#include "runner/editor/previews/watched_files.h"

#include <algorithm>
#include <chrono>

#include "graphs/text/json.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

constexpr size_t most_files_watched = 4096;

/// Texts that may be paths: also of files that are missing, or whose node has a mistake.
void collect_paths(const JsonValue& value, const fs::path& folder, std::vector<fs::path>& out) {
  constexpr size_t longest = 1024;
  if (value.is_text() && !value.text.empty() && value.text.size() < longest &&
      value.text.find_first_of("@$={*\n") == std::string::npos && out.size() < most_files_watched)
    out.push_back(folder / value.text);
  for (const JsonValue& item : value.items) collect_paths(item, folder, out);
  for (const JsonMember& m : value.members) collect_paths(m.value, folder, out);
}

std::vector<fs::path> files_of(const EditedGraph& graph, const std::string& text, const fs::path& folder) {
  std::vector<fs::path> out;
  if (const ParsedJson parsed = parse_json(text); parsed.value)
    for (const char* section : {"nodes", "graphs", "parameters"})
      if (const JsonValue* part = parsed.value->find(section)) collect_paths(*part, folder, out);
  if (!graph.loaded) return out;
  for (const GraphNode& n : graph.loaded->graph.nodes) try {
      if (n.type->files_read && !n.is_open)
        for (fs::path& file : n.type->files_read(n.params))
          if (out.size() < 2 * most_files_watched) out.push_back(std::move(file));
    } catch (const Error&) {
      // It is reported with the node.
    }
  return out;
}

}  // namespace

bool WatchedFiles::have_changed(const std::shared_ptr<const EditedGraph>& graph, const std::string& text,
                                const fs::path& document, const Sandbox& sandbox) {
  if (!graph) return false;
  Facts now;
  within(sandbox, [&] {
    for (const fs::path& file : files_of(*graph, text, document.parent_path())) {
      std::error_code missing;
      if (!sandbox.trouble_with("read", file).empty()) continue;
      const fs::file_time_type time = fs::last_write_time(file, missing);
      if (missing) continue;
      const uintmax_t size = fs::is_regular_file(file, missing) ? fs::file_size(file, missing) : 0;
      now[file] = {time, size};
    }
  });
  const bool is_same_graph = graph == graph_ && text == text_;
  // A file that was written while the graph was loaded may have been read before that. File systems' clocks are coarse.
  const auto present = fs::file_time_type::clock::now();
  const bool is_newer = std::ranges::any_of(now, [&](const auto& file) {
    return file.second.first >= graph->begun - std::chrono::milliseconds(10) && file.second.first <= present;
  });
  const bool out = is_same_graph ? now != facts_ : is_newer;
  graph_ = graph;
  text_ = text;
  facts_ = std::move(now);
  return out;
}

}  // namespace terrazzo
