#include "graphs/document/forecast_pass.h"

#include <algorithm>

#include <fmt/format.h>

#include "graphs/document/left_out.h"

namespace terrazzo {

namespace {

/// Represents a queried node whose results cannot be known, for reasons that have been reported.
constexpr const char* never_known = "?";

}  // namespace

/// The source of results that an expression queries, resolved through inputs and subgraphs.
WireSources ForecastPass::sources_behind(const std::string& asked) const {
  const size_t name = asked.rfind('/') + 1;  // 0 if there is none
  const Level* level = levels_.find(asked.substr(0, name));
  std::vector<Problem> ignored;
  Diagnostics diagnostics(ignored, "");
  return level ? sources_of(*level, {asked.substr(name), "", {}, ""}, diagnostics) : WireSources{};
}

/// The node whose results an expression queries. Throws Error if there is not exactly one.
std::string ForecastPass::node_behind(const std::string& asked) const {
  const WireSources found = sources_behind(asked);
  if (found.wires.size() > 1) throw Error(fmt::format("\"{}\" is a loop, of {} iterations", asked, found.wires.size()));
  if (found.wires.empty()) throw Error(fmt::format("nothing comes into \"{}\"", asked));
  return found.wires.front().node;
}

void ForecastPass::resolve_queries_of(NodeDraft& draft) const {
  std::set<std::string> nodes;
  for (const std::string& name : draft.asked) {
    WireSources found = sources_behind(name);
    if (found.is_faulty || !found.open.empty()) nodes.emplace(never_known);
    if (found.wires.size() == 1) nodes.insert(found.wires.front().node);
    draft.unset.merge(found.open);
  }
  draft.asked = std::move(nodes);
}

void ForecastPass::resolve_queries() {
  for (NodeDraft& d : levels_.nodes()) resolve_queries_of(d);
  for (NodeDraft& d : levels_.others()) resolve_queries_of(d);
}

void ForecastPass::run(const std::vector<size_t>& order, Level& root) {
  std::vector<std::string> asked;
  bool has_waiting = false;
  for (const Drafts* drafts : {&levels_.nodes(), &levels_.others()})
    for (const NodeDraft& d : *drafts) {
      asked.insert(asked.end(), d.asked.begin(), d.asked.end());
      has_waiting |= !d.waiting.empty();
    }
  if (asked.empty() && !has_waiting) return;
  Drafts& drafts = levels_.nodes();
  for (const NodeDraft& d : drafts) by_name_[d.node.name] = &d;
  incomplete_ = {never_known};
  set_forecasts([this](const std::string& name) -> const Forecast& {
    const std::string node = node_behind(name);
    if (const Forecast* found = forecasts_.find(node)) return *found;
    throw Error(fmt::format("the results of \"{}\" are not known before it runs", node));
  });
  const std::set<std::string> needed = needed_nodes(drafts, asked);
  for (const size_t i : order) {
    NodeDraft& d = drafts[i];
    const bool complete = are_sources_complete(d);
    if (complete) read_waiting_in(d);
    if (needed.contains(d.node.name) && !(complete && look_ahead(d))) incomplete_.insert(d.node.name);
    if (!incomplete_.contains(d.node.name)) known_.insert(d.node.name);
  }
  evaluate_rest(root);
  set_forecasts({});
}

/// Sets the source of forecasts for every scope.
void ForecastPass::set_forecasts(const GraphScope::Forecasts& forecasts) {
  for (const std::unique_ptr<Level>& level : levels_.all()) {
    level->names.scope->set_forecasts(forecasts);
    for (const std::unique_ptr<NodeScope>& iteration : level->iterations) iteration->scope->set_forecasts(forecasts);
  }
}

/// Whether the nodes that this one queries could be forecast. What they lack, this one lacks too.
bool ForecastPass::are_sources_complete(NodeDraft& draft) const {
  bool complete = true;
  for (const std::string& source : draft.asked) {
    complete &= !incomplete_.contains(source);
    if (const auto at = by_name_.find(source); at != by_name_.end())
      draft.unset.insert(at->second->unset.begin(), at->second->unset.end());
  }
  return complete;
}

/// Reads the node's values that wait for forecasts, after those of the enclosing nodes.
void ForecastPass::read_waiting_in(NodeDraft& draft) {
  const size_t before = problems_.size();
  read_uses(*draft.level);
  if (!draft.waiting.empty()) read_waiting(draft, problems_);
  set_file(problems_, before, draft.node.file);
}

/// Reads such values of the node that this level is a use of, and of enclosing ones, once all that they query is known.
void ForecastPass::read_uses(Level& level) {
  if (!level.use) return;
  read_uses(*level.outer);
  NodeDraft& use = *level.use;
  if (use.waiting.empty() || !std::ranges::all_of(use.asked, [&](const std::string& n) { return known_.contains(n); }))
    return;
  const size_t before = problems_.size();
  read_waiting(use, problems_);
  set_file(problems_, before, use.node.file);
  use.asked.clear();
  bind_parameters(level);
}

/// Whether the forecast succeeded; errors of the node's hooks become problems.
bool ForecastPass::look_ahead(const NodeDraft& draft) {
  const GraphNode& node = draft.node;
  if (!is_complete(draft)) return false;
  for (const auto& [port, wires] : node.inputs)
    for (const Wire& w : wires)
      if (incomplete_.contains(w.node)) return false;
  const size_t before = of_sources_.size();
  try {
    forecasts_.add(node);
    return true;
  } catch (const Errors& all) {
    for (const Error& e : all.all()) of_sources_.push_back(problem_of(node, e.about(), e.what()));
  } catch (const Error& e) {
    of_sources_.push_back(problem_of(node, e.about(), e.what()));
  }
  set_file(of_sources_, before, node.file);
  return false;
}

/// The document's own parameters that no node uses, as far as their queries are known.
void ForecastPass::evaluate_rest(Level& root) {
  GraphScope& scope = *root.names.scope;
  for (const GraphParameter& p : root.names.parameters) {
    if (!p.formula) continue;
    const auto is_known = [&](const std::pair<const std::string, size_t>& asked) {
      const WireSources found = sources_behind(asked.first);
      return !found.is_faulty && found.open.empty() && found.wires.size() == 1 &&
             !incomplete_.contains(found.wires.front().node);
    };
    if (std::ranges::all_of(p.formula->expression->nodes(), is_known)) scope.find(p.param.name);
  }
}

}  // namespace terrazzo
