#include "runner/api/job.h"

#include <algorithm>
#include <deque>
#include <map>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "graphs/document/load.h"
#include "graphs/text/format.h"
#include "graphs/text/read_document.h"
#include "graphs/values/convert.h"
#include "runner/plan/planning.h"
#include "runner/plan/preflight.h"
#include "runner/plan/source_findings.h"

namespace terrazzo {

namespace {

constexpr const char* digest_param = "digest";

/// A node that outputs a value given by a program. The value's digest is its only parameter and thus determines its
/// key.
NodeType given_type(const std::string& name, const Port& output, const Value& value) {
  NodeType t;
  t.name = "given " + name;
  t.category = "source";
  t.summary = "A value that a program has given";
  t.outputs = {output};
  t.params = {{.name = digest_param, .type = ParamType::text, .fallback = digest_of(value).hex()}};
  t.persist = Persist::digest;
  t.compute = [output, value](NodeContext& node) { node.output(output.name, value); };
  return t;
}

/// Replaces the node by one that outputs the value.
void replace_node(GraphNode& node, const Value& value, std::deque<NodeType>& types) {
  if (node.type->outputs.size() != 1)
    throw Error(node.name, fmt::format("node \"{}\" has {} outputs; a value can only be given in place of one",
                                       node.name, node.type->outputs.size()));
  const Port& output = node.type->outputs.front();
  if (!converts(type_of(value), output.type))
    throw Error(node.name, fmt::format("node \"{}\" gives {}, and was given {}", node.name, name_of(output.type),
                                       name_of(type_of(value))));
  types.push_back(given_type(node.name, output, converted(value, output.type)));
  node.type = &types.back();
  node.params = {{digest_param, *types.back().params.front().fallback}};
  node.inputs.clear();
}

}  // namespace

struct CheckedJob::State {
  std::deque<NodeType> given;  ///< a deque, so that addresses stay valid
  LoadedGraph loaded;
};

const Graph& CheckedJob::graph() const {
  return state_->loaded.graph;
}

const std::vector<Problem>& CheckedJob::warnings() const {
  return state_->loaded.warnings;
}

Job Job::open(const std::filesystem::path& graph) {
  Job job = from_text(read_document(graph), graph);
  job.parameters();  // throws if the text is not a graph
  return job;
}

Job Job::from_text(std::string text, const std::filesystem::path& as) {
  Job job;
  job.text_ = std::move(text);
  job.path_ = as;
  return job;
}

Job& Job::set(const std::string& name, const ParamValue& value) {
  return set_text(name, compact(json_of(value)));
}

Job& Job::set_text(const std::string& name, const std::string& value) {
  unset(name);
  values_.emplace_back(name, value);
  return *this;
}

Job& Job::unset(const std::string& name) {
  std::erase_if(values_, [&](const auto& v) { return v.first == name; });
  return *this;
}

std::vector<Override> Job::overrides() const {
  std::vector<Override> out;
  for (const auto& [name, value] : values_) out.push_back(override_of(name, value));
  return out;
}

Job& Job::preset(const std::string& name) {
  presets_.push_back(name);
  return *this;
}

Job& Job::settings(const std::filesystem::path& file) {
  settings_.push_back(file);
  return *this;
}

Job& Job::give(const std::string& name, Value value) {
  std::erase_if(given_, [&](const auto& g) { return g.first == name; });
  given_.emplace_back(name, std::move(value));
  return *this;
}

std::vector<JobParameter> Job::parameters() const {
  const LoadedGraph loaded =
      load_graph_text(text_, path_, overrides(), {.presets = presets_, .settings = settings_, .allow_unset = true});
  std::vector<JobParameter> out;
  for (const GraphParameter& p : loaded.parameters) out.push_back({p.param, p.group, p.value});
  return out;
}

std::vector<Problem> Job::check() const {
  try {
    make_plan(checked().graph(), nullptr);  // also checks files
    return {};
  } catch (const GraphError& e) {
    return e.problems();
  } catch (const Error& e) {
    return {{{}, "", e.what(), e.about(), "", "input"}};
  }
}

std::vector<Problem> Job::warnings() const {
  if (!check().empty()) return {};
  const CheckedJob job = checked();
  std::vector<Problem> out = job.warnings();
  for (Problem& p : look_at_sources(job.graph(), CurrentTask::task()).warnings) out.push_back(std::move(p));
  for (Problem& p : lint_of(job.graph(), CurrentTask::task())) out.push_back(std::move(p));
  return out;
}

CheckedJob Job::checked(const std::vector<std::string>& only) const {
  auto state = std::make_shared<CheckedJob::State>();
  LoadOptions options{.presets = presets_, .settings = settings_, .only = only, .look_ahead = preflight_of_nodes};
  for (const auto& [name, value] : given_)
    options.inputs.emplace(
        name, &state->given.emplace_back(given_type(name, {.name = "value", .type = type_of(value)}, value)));
  state->loaded = load_graph_text(text_, path_, overrides(), options);
  std::vector<GraphNode>& nodes = state->loaded.graph.nodes;
  std::vector<std::string> names;
  for (const GraphNode& n : nodes) names.push_back(n.name);
  for (const auto& [name, value] : given_) {
    if (std::ranges::find(state->loaded.given, name) != state->loaded.given.end()) continue;
    const auto node = std::ranges::find(nodes, name, &GraphNode::name);
    if (node == nodes.end())
      throw Error(name, fmt::format("a value was given for \"{}\", which is neither an input nor a node of the graph{}",
                                    name, did_you_mean(name, names)));
    replace_node(*node, value, state->given);
  }
  CheckedJob job;
  job.state_ = std::move(state);
  return job;
}

}  // namespace terrazzo
