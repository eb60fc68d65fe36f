#include "runner/engine/run_result.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/text.h"

namespace terrazzo {

int RunResult::count(StageOutcome::Kind kind) const {
  return static_cast<int>(
      std::count_if(stages.begin(), stages.end(), [&](const StageOutcome& s) { return s.kind == kind; }));
}

std::string RunResult::summary() const {
  using Kind = StageOutcome::Kind;
  const int reused = count(Kind::reused), run = count(Kind::run), failed = count(Kind::failed),
            skipped = count(Kind::skipped), unfinished = count(Kind::unfinished),
            all = reused + run + failed + skipped + unfinished;
  std::string out = fmt::format("{}: {} cached, {} run", counted(all, "stage"), reused, run);
  if (failed > 0) out += fmt::format(", {} failed", failed);
  if (skipped > 0) out += fmt::format(", {} skipped because of that", skipped);
  if (unfinished > 0) out += fmt::format(", {} not run", unfinished);
  return out + fmt::format(", {:.2f} s", seconds);
}

std::vector<std::string> RunResult::skips() const {
  std::map<std::string, std::vector<std::string>> by_cause;
  for (const StageOutcome& s : stages)
    if (s.kind == StageOutcome::Kind::skipped) by_cause[s.because].push_back(s.node);
  constexpr size_t most_named = 20;
  std::vector<std::string> out;
  for (auto& [cause, nodes] : by_cause) {
    const size_t more = nodes.size() - std::min(nodes.size(), most_named);
    nodes.resize(nodes.size() - more);
    out.push_back(fmt::format("skipped, as \"{}\" failed: {}{}", cause, fmt::join(nodes, ", "),
                              more > 0 ? fmt::format(" and {} more", more) : ""));
  }
  return out;
}

}  // namespace terrazzo
