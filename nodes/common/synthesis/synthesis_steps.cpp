#include "nodes/common/synthesis/synthesis_steps.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/synthesis/steps.h"

namespace terrazzo {

namespace {

constexpr int levels = 8;  // enough to distinguish conditions counted from the finest and from the coarsest level

struct Situation {
  std::string name;
  LevelFacts facts;
};

const std::vector<Situation>& situations() {
  static const std::vector<Situation> all = {{"without a lattice", {}},
                                             {"with a lattice", {.regular = true}},
                                             {"with courses of elements", {.regular = true, .bands = true}},
                                             {"with kept pixels", {.kept = true}},
                                             {"with a target", {.steered = true}}};
  return all;
}

/// The levels on which the step applies, in words; empty if none.
std::string levels_of(const Step& step, LevelFacts facts) {
  facts.levels = levels;
  int first = levels, last = -1, count = 0;
  for (facts.level = 0; facts.level < levels; facts.level++) {
    if (!step.applies(facts)) continue;
    first = std::min(first, facts.level);
    last = facts.level;
    count++;
  }
  if (count == 0) return "";
  if (count == levels || step.phase == Phase::coarsest) return "always";
  if (count != last - first + 1) throw std::logic_error("a step of the synthesis applies on levels with gaps between");
  if (first == last) return fmt::format("level {}", first);
  if (first == 0) return fmt::format("levels 0 to {}", last);
  if (last < levels - 1) return fmt::format("levels {} to {}", first, last);
  return first > levels / 2 ? fmt::format("the {} coarsest levels", count) : fmt::format("level {} and coarser", first);
}

std::string when_of(const Step& step) {
  std::vector<std::pair<std::string, std::vector<std::string>>> groups;  // situations by levels
  bool in_drafts = false;
  size_t known = 0;
  for (const Situation& s : situations()) {
    LevelFacts facts = s.facts;
    const std::string where = levels_of(step, facts);
    facts.quality = Quality::draft;
    in_drafts |= !levels_of(step, facts).empty();
    if (where.empty()) continue;
    known++;
    const auto at = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == where; });
    if (at == groups.end())
      groups.push_back({where, {s.name}});
    else
      at->second.push_back(s.name);
  }
  std::vector<std::string> parts = {std::string(phase_names[size_t(step.phase)])};
  for (const auto& [where, names] : groups) {
    const bool everywhere = groups.size() == 1 && known == situations().size();
    if (everywhere && where == "always") continue;
    parts.push_back(everywhere ? where : fmt::format("{}: {}", fmt::join(names, ", "), where));
  }
  if (!in_drafts) parts.push_back("not in drafts");
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace

std::vector<NodeStep> described_synthesis_steps() {
  std::vector<NodeStep> out;
  for (const Step& step : synthesis_steps())
    out.push_back({std::string(step.name), when_of(step), std::string(step.purpose)});
  return out;
}

}  // namespace terrazzo
