#include "runner/report/trace.h"

#include <nlohmann/json.hpp>

#include "core/file/atomic_file.h"

namespace terrazzo {

void write_trace(const RunResult& result, const std::filesystem::path& path) {
  using Json = nlohmann::ordered_json;
  Json events = Json::array();
  for (const Span& s : result.spans) {
    const std::string& node = result.stages[static_cast<size_t>(s.stage)].node;
    events.push_back({{"name", s.what == "run" ? node : s.what + " " + node},
                      {"cat", s.what},
                      {"ph", "X"},
                      {"ts", s.start * 1e6},
                      {"dur", (s.end - s.start) * 1e6},
                      {"pid", 1},
                      {"tid", s.thread}});
  }
  const Json trace = {{"displayTimeUnit", "ms"}, {"traceEvents", std::move(events)}};
  write_whole_file(path, trace.dump(1, ' ', false, Json::error_handler_t::replace) + '\n');
}

}  // namespace terrazzo
