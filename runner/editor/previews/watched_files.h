#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "runner/editor/previews/graph_loading.h"

namespace terrazzo {

/// Notices when files change that an edited graph reads, or would read if they were there. Not thread-safe.
class WatchedFiles {
 public:
  /// Whether one has changed, come or gone since the last call with this graph and text, or
  /// since this graph was loaded. Looks at names, times and
  /// sizes only, and at nothing that the sandbox does not allow.
  bool have_changed(const std::shared_ptr<const EditedGraph>& graph, const std::string& text,
                    const std::filesystem::path& document, const Sandbox& sandbox);

 private:
  using Facts = std::map<std::filesystem::path, std::pair<std::filesystem::file_time_type, uintmax_t>>;
  std::shared_ptr<const EditedGraph> graph_;
  std::string text_;
  Facts facts_;
};

}  // namespace terrazzo
