#include "graphs/document/wires.h"

#include <map>

#include <fmt/format.h>

#include "core/base/suggest.h"

namespace terrazzo {

namespace {

using Positions = std::map<std::string, size_t, std::less<>>;

Positions positions_of(const std::vector<NodeDraft>& drafts) {
  Positions out;
  for (size_t i = 0; i < drafts.size(); i++) out.emplace(drafts[i].node.name, i);
  return out;
}

class Connector {
 public:
  Connector(std::vector<NodeDraft>& drafts, std::vector<Problem>& conversions)
      : drafts_(drafts), conversions_(conversions), positions_(positions_of(drafts)) {}

  void connect(GraphNode& node, PortWires& into) {
    std::vector<Wire> wires;
    for (const WireEnd& end : into.wires) {
      const Port* output = find_output(end, into);
      if (!output || !types_fit(node, end, *output, into)) continue;
      wires.push_back({end.node, output->name});
      if (output->type != into.port->type)
        conversions_.push_back(
            {end.place, fmt::format("node {}, port {}", in_quotes(node.name), in_quotes(into.port->name)),
             fmt::format("the image of {} becomes a material of one map", in_quotes(end.spelled)), node.name});
    }
    if (!wires.empty()) node.inputs[into.port->name] = std::move(wires);
  }

 private:
  /// Null after a problem, or if the node's type is unknown.
  const Port* find_output(const WireEnd& end, PortWires& into) const {
    const auto at = positions_.find(end.node);
    if (at == positions_.end()) {
      std::vector<std::string> names;
      for (const NodeDraft& d : drafts_) names.push_back(d.node.name);
      into.diagnostics.add(end.place,
                           fmt::format("{} leads to no node{}", in_quotes(end.spelled), suggestion(end.node, names)));
      return nullptr;
    }
    const NodeType* type = drafts_[at->second].node.type;
    if (!type) return nullptr;
    if (type->outputs.empty()) {
      into.diagnostics.add(end.place, fmt::format("{} leads to a node of type {}, which has no output",
                                                  in_quotes(end.spelled), type->name));
      return nullptr;
    }
    if (end.port.empty()) return &type->outputs.front();
    const Port* output = type->find_output(end.port);
    if (!output) {
      std::vector<std::string> names;
      for (const Port& p : type->outputs) names.push_back(p.name);
      into.diagnostics.add(end.place, fmt::format("{} has no output {}{}", type->name, in_quotes(end.port),
                                                  suggestion(end.port, names)));
    }
    return output;
  }

  bool types_fit(const GraphNode& reader, const WireEnd& end, const Port& output, PortWires& into) const {
    const ValueType wanted = into.port->type;
    if (converts(output.type, wanted)) return true;
    into.diagnostics.add(end.place, fmt::format("expected a wire of type {}, found {}, which is of type {}{}",
                                                name_of(wanted), in_quotes(end.spelled), name_of(output.type),
                                                fitting_outputs(wanted, end.node, reader.name)));
    return false;
  }

  /// Which wires would fit: those of the node itself, if it has any, else those of all nodes.
  std::string fitting_outputs(ValueType wanted, const std::string& node, const std::string& reader) const {
    std::vector<std::string> own, all;
    for (const NodeDraft& d : drafts_) {
      if (!d.node.type || d.node.name == reader) continue;
      const std::vector<Port>& outputs = d.node.type->outputs;
      for (size_t i = 0; i < outputs.size(); i++) {
        if (outputs[i].type != wanted) continue;
        const std::string wire = i == 0 ? "@" + d.node.name : fmt::format("@{}.{}", d.node.name, outputs[i].name);
        (d.node.name == node ? own : all).push_back(wire);
      }
    }
    const std::vector<std::string>& fitting = own.empty() ? all : own;
    return fitting.empty() ? fmt::format("; no node here makes one of type {}", name_of(wanted))
                           : fmt::format(" (would fit: {})", listed(fitting));
  }

  std::vector<NodeDraft>& drafts_;
  std::vector<Problem>& conversions_;
  Positions positions_;
};

/// A depth-first walk against the wires, without recursion: a chain of nodes may be long.
class Walk {
 public:
  Walk(const std::vector<NodeDraft>& drafts, std::vector<Problem>& problems)
      : drafts_(drafts), problems_(problems), sources_(drafts.size()), state_(drafts.size(), State::unseen) {
    const Positions positions = positions_of(drafts);
    for (size_t i = 0; i < drafts.size(); i++)
      for (const PortWires& p : drafts[i].ports)
        for (const WireEnd& end : p.wires)
          if (const auto at = positions.find(end.node); at != positions.end()) sources_[i].push_back(at->second);
    for (size_t i = 0; i < drafts.size(); i++)
      for (const std::string& asked : drafts[i].asked)
        if (const auto at = positions.find(asked); at != positions.end()) {
          sources_[i].push_back(at->second);
          reads_ = "the wires, and expressions that ask for nodes, form a cycle: ";
        }
  }

  std::vector<size_t> order() {
    for (size_t i = 0; i < drafts_.size(); i++)
      if (state_[i] == State::unseen) visit(i);
    return std::move(order_);
  }

 private:
  enum class State : uint8_t { unseen, open, done };
  struct Step {
    size_t node;
    size_t next = 0;
  };

  void visit(size_t start) {
    std::vector<Step> path;
    const auto enter = [&](size_t node) {
      state_[node] = State::open;
      path.push_back({node});
    };
    enter(start);
    while (!path.empty()) {
      Step& top = path.back();
      if (top.next == sources_[top.node].size()) {
        state_[top.node] = State::done;
        order_.push_back(top.node);
        path.pop_back();
        continue;
      }
      const size_t source = sources_[top.node][top.next++];
      if (state_[source] == State::open) report_cycle(path, source);
      if (state_[source] == State::unseen) enter(source);
    }
  }

  /// Each step of the path reads the next one, and the last one reads `closing` again.
  void report_cycle(const std::vector<Step>& path, size_t closing) {
    std::string names = drafts_[closing].node.name;
    size_t first = closing;
    for (size_t i = path.size(); i-- > 0;) {
      names += " -> " + drafts_[path[i].node].node.name;
      first = std::min(first, path[i].node);
      if (path[i].node == closing) break;
    }
    const GraphNode& node = drafts_[first].node;
    problems_.push_back({node.place, "node " + in_quotes(node.name), reads_ + names, node.name});
  }

  const std::vector<NodeDraft>& drafts_;
  std::vector<Problem>& problems_;
  std::vector<std::vector<size_t>> sources_;
  std::string reads_ = "the wires form a cycle: ";
  std::vector<State> state_;
  std::vector<size_t> order_;
};

}  // namespace

void connect(std::vector<NodeDraft>& drafts, std::vector<Problem>& problems, std::vector<Problem>& conversions) {
  Connector connector(drafts, conversions);
  for (NodeDraft& d : drafts) {
    const size_t before = problems.size();
    for (PortWires& p : d.ports) connector.connect(d.node, p);
    for (size_t i = before; i < problems.size(); i++) problems[i].node = d.node.name;
  }
}

std::vector<size_t> execution_order(const std::vector<NodeDraft>& drafts, std::vector<Problem>& problems) {
  return Walk(drafts, problems).order();
}

std::set<std::string> needed_nodes(const std::vector<NodeDraft>& drafts, std::vector<std::string> names) {
  const Positions positions = positions_of(drafts);
  std::set<std::string> out;
  while (!names.empty()) {
    const auto at = positions.find(names.back());
    names.pop_back();
    if (at == positions.end() || !out.insert(std::string(at->first)).second) continue;
    for (const PortWires& p : drafts[at->second].ports)
      for (const WireEnd& w : p.wires) names.push_back(w.node);
  }
  return out;
}

}  // namespace terrazzo
