#include "runner/report/stage_table.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "core/base/text.h"
#include "runner/report/page.h"
#include "runner/report/run_data.h"

namespace terrazzo {

namespace {

constexpr size_t most_in_one_table = 40;  ///< rows: a screen or two

/// "seed 7" of "layout [seed 7]", "walls/3" of "walls/3/layout"; empty if the node belongs to the graph itself.
std::string owner_of(const std::string& node) {
  const size_t label = node.rfind(" [");
  if (label != std::string::npos && node.ends_with(']')) return node.substr(label + 2, node.size() - label - 3);
  const size_t part = node.rfind('/');
  return part == std::string::npos ? "" : node.substr(0, part);
}

std::string row_of(const Stage& stage, const StageOutcome& s) {
  return fmt::format(
      "<tr{}><td>{}</td><td>{}</td><td>{}</td><td class=\"number\">{}</td><td class=\"quiet\">{}</td><td "
      "class=\"quiet\">{}</td></tr>\n",
      s.kind == StageOutcome::Kind::failed ? " class=\"failed\"" : "", markup(s.node), markup(stage.type().name),
      what_it_did(stage, s), s.kind == StageOutcome::Kind::run ? fmt::format("{:.2f}", s.seconds) : "",
      markup(reason_of(stage, s)), markup(settings_text(*stage.node)));
}

std::string table_of(const Plan& plan, const RunResult& result, const std::vector<size_t>& stages) {
  std::string out =
      "<div class=\"scroll\"><table class=\"sortable stages\">\n<thead><tr><th>node</th><th>type</th><th>what it "
      "did</th><th>seconds</th><th>why</th><th>parameters that were set</th></tr></thead>\n<tbody>\n";
  for (const size_t i : stages) out += row_of(plan.stages[i], result.stages[i]);
  return out + "</tbody></table></div>\n";
}

/// "12 nodes: 3 run, 9 cached; 1.25 s".
std::string count_of(const Plan& plan, const RunResult& result, const std::vector<size_t>& stages) {
  std::map<std::string_view, int64_t> counts;
  double seconds = 0;
  for (const size_t i : stages) {
    counts[what_it_did(plan.stages[i], result.stages[i])]++;
    if (result.stages[i].kind == StageOutcome::Kind::run) seconds += result.stages[i].seconds;
  }
  std::string did;
  for (const auto& [what, count] : counts) did += fmt::format("{}{} {}", did.empty() ? "" : ", ", count, what);
  return fmt::format("{}: {}{}", counted(int64_t(stages.size()), "node"), did,
                     seconds > 0 ? fmt::format("; {:.2f} s", seconds) : "");
}

}  // namespace

std::string stage_table(const Plan& plan, const RunResult& result) {
  std::vector<std::string> owners;  // in the order in which they come
  std::map<std::string, std::vector<size_t>> stages;
  for (size_t i = 0; i < plan.stages.size(); i++) {
    const std::string owner = plan.stages.size() > most_in_one_table ? owner_of(result.stages[i].node) : "";
    std::vector<size_t>& of_owner = stages[owner];
    if (of_owner.empty() && !owner.empty()) owners.push_back(owner);
    of_owner.push_back(i);
  }
  std::string out, folded;
  if (const auto own = stages.find(""); own != stages.end()) out = table_of(plan, result, own->second);
  for (const std::string& owner : owners) {
    const std::vector<size_t>& of_owner = stages.at(owner);
    const bool failed =
        std::ranges::any_of(of_owner, [&](size_t i) { return result.stages[i].kind == StageOutcome::Kind::failed; });
    folded +=
        fold(fmt::format("<b>{}</b> <span class=\"quiet\">{}</span>", markup(owner), count_of(plan, result, of_owner)),
             table_of(plan, result, of_owner), failed);
  }
  return folded.empty() ? out : fmt::format("{}<div class=\"long\">\n{}</div>\n", out, folded);
}

std::vector<std::string> notes_html(const RunResult& result, bool only_warnings) {
  std::vector<std::string> messages;
  std::map<std::string, std::vector<std::string>> nodes;
  for (const StageOutcome& s : result.stages)
    for (const std::string& n : s.notes) {
      if (only_warnings && !is_warning(n)) continue;
      std::vector<std::string>& saying = nodes[n];
      if (saying.empty()) messages.push_back(n);
      if (saying.empty() || saying.back() != s.node) saying.push_back(s.node);
    }
  std::vector<std::string> out;
  for (const std::string& n : messages) {
    const std::vector<std::string>& saying = nodes.at(n);
    const std::string more =
        saying.size() > 1 ? " and " + counted(int64_t(saying.size()) - 1, "more node") : std::string();
    out.push_back(fmt::format("<span{}>{}{}: {}</span>", is_warning(n) ? " class=\"failed\"" : "",
                              markup(saying.front()), more, markup(n)));
  }
  return out;
}

}  // namespace terrazzo
