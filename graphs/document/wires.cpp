#include "graphs/document/wires.h"

#include <map>

#include <fmt/format.h>

#include "core/base/suggest.h"

namespace terrazzo {

namespace {

constexpr size_t most_wires = 1000000;  // loops that read loops may otherwise exceed any memory

using Positions = std::map<std::string, size_t, std::less<>>;

Positions positions_of(const Drafts& drafts) {
  Positions out;
  for (size_t i = 0; i < drafts.size(); i++) out.emplace(drafts[i].node.name, i);
  return out;
}

/// Checks the wires of one level.
class WireChecker {
 public:
  WireChecker(const Subgraph& graph, std::string path, std::vector<Problem>& conversions)
      : graph_(graph), path_(std::move(path)), sources_(graph.sources), conversions_(conversions) {}

  /// `reader` is the node's name in its graph.
  void check(const std::string& reader, PortWires& into) {
    std::erase_if(into.wires, [&](WireEnd& end) {
      const Port* output = nullptr;
      const std::string fault = fault_of(reader, end, *into.port, output);
      if (!fault.empty()) into.diagnostics.add(end.place, fault);
      if (!fault.empty() || !output) {
        into.has_faults = true;
        return true;
      }
      end.port = output->name;
      if (output->type != into.port->type)
        conversions_.push_back({end.place,
                                fmt::format("node {}, port {}", in_quotes(path_ + reader), in_quotes(into.port->name)),
                                fmt::format("the image of {} becomes a material of one map", in_quotes(end.spelled)),
                                path_ + reader, graph_.file});
      return false;
    });
  }

  /// Why the wire does not fit; empty if it does, with its output, or if its node's type is unknown.
  std::string fault_of(const std::string& reader, const WireEnd& end, const Port& into, const Port*& output) {
    const auto* source = graph_.find_source(end.node);
    if (!source) return fmt::format("{} leads to no node{}", in_quotes(end.spelled), nearest_nodes(end.node));
    const NodeType* type = source->second;
    if (!type) return "";
    if (type->outputs.empty())
      return fmt::format("{} leads to a node of type {}, which has no output", in_quotes(end.spelled), type->name);
    output = end.port.empty() ? &type->outputs.front() : type->find_output(end.port);
    if (!output) {
      std::vector<std::string> names;
      for (const Port& p : type->outputs) names.push_back(p.name);
      return fmt::format("{} has no output {}{}", type->name, in_quotes(end.port), suggestion(end.port, names));
    }
    if (converts(output->type, into.type)) return "";
    return fmt::format("expected a wire of type {}, found {}, which is of type {}{}", name_of(into.type),
                       in_quotes(end.spelled), name_of(output->type), fitting_outputs(into.type, end.node, reader));
  }

 private:
  /// Hints search all nodes, so only problems that may be shown get one.
  bool is_worth_a_hint() { return hints_++ < most_problems_shown; }

  std::string nearest_nodes(const std::string& wrong) {
    if (!is_worth_a_hint()) return "";
    std::vector<std::string> names;
    for (const auto& [name, type] : sources_) names.push_back(name);
    return suggestion(wrong, names);
  }

  /// Suggests fitting wires: from the node itself if there are any, else from all nodes.
  std::string fitting_outputs(ValueType wanted, const std::string& node, const std::string& reader) {
    if (!is_worth_a_hint()) return "";
    std::vector<std::string> own, all;
    for (const auto& [name, type] : sources_) {
      if (!type || name == reader) continue;
      for (size_t i = 0; i < type->outputs.size(); i++) {
        if (type->outputs[i].type != wanted) continue;
        const std::string wire = i == 0 ? "@" + name : fmt::format("@{}.{}", name, type->outputs[i].name);
        (name == node ? own : all).push_back(wire);
      }
    }
    const std::vector<std::string>& fitting = own.empty() ? all : own;
    return fitting.empty() ? fmt::format("; no node here makes one of type {}", name_of(wanted))
                           : fmt::format(" (would fit: {})", listed(fitting));
  }

  const Subgraph& graph_;
  const std::string path_;
  const NodeTypes& sources_;
  std::vector<Problem>& conversions_;
  size_t hints_ = 0;
};

/// Follows a wire back to nodes that run.
class WireFollower {
 public:
  explicit WireFollower(Diagnostics& asking) : asking_(asking) {}

  void follow(const Level& level, const WireEnd& end) {
    if (++steps_ > most_steps) {
      if (!out_.is_faulty) asking_.add(end.place, "the wires of subgraphs form a cycle");
      out_.is_faulty = true;
    } else if (const std::vector<NodeInstance>* items = level.find(end.node)) {
      out_.is_faulty |= items->empty();  // a loop that could not be read
      for (const NodeInstance& item : *items) from_item(level, item, end);
    } else {
      from_input(level, end);
    }
    steps_--;
  }

  WireSources take() { return std::move(out_); }

 private:
  static constexpr int most_steps = 1000;

  void from_input(const Level& level, const WireEnd& end) {
    if (!level.use) {
      const auto input = std::ranges::find(level.graph->inputs, end.node, &Port::name);
      if (input != level.graph->inputs.end() && !input->optional) out_.open.insert(end.node);
      return;
    }
    // A missing required wire has been reported.
    const Port* input = level.use->node.type->find_input(end.node);
    out_.is_faulty |= input && !input->optional && !level.use->node.places.contains(end.node);
    for (const PortWires& p : level.use->ports) {
      if (p.port->name != end.node) continue;
      out_.is_faulty |= p.has_faults;
      if (p.wires.empty()) out_.open.insert(level.use->unset.begin(), level.use->unset.end());
      for (const WireEnd& outer : p.wires) follow(*level.outer, outer);
    }
  }

  void from_item(const Level& level, const NodeInstance& item, const WireEnd& end) {
    const NodeDraft& draft = *item.draft;
    const NodeType* type = draft.node.type;
    const Port* output = !type || type->outputs.empty() ? nullptr
                         : end.port.empty()             ? &type->outputs.front()
                                                        : type->find_output(end.port);
    if (!output) {
      out_.is_faulty = true;
    } else if (draft.muted) {
      pass_through(level, draft, output->type, end);
    } else if (type->category != graph_category) {
      if (out_.wires.size() < most_wires) out_.wires.push_back({draft.node.name, output->name});
    } else {
      const PortWires* from = item.inner ? item.inner->find_output(output->name) : nullptr;
      out_.is_faulty |= !from || from->has_faults || from->wires.empty();
      if (from)
        for (const WireEnd& inner : from->wires) follow(*item.inner, inner);
    }
  }

  /// The output of a muted node: the input of its first port of the same type.
  void pass_through(const Level& level, const NodeDraft& muted, ValueType type, const WireEnd& end) {
    for (const Port& port : muted.node.type->inputs)
      for (const PortWires& p : muted.ports)
        if (p.port->name == port.name && port.type == type && !p.wires.empty()) return follow(level, p.wires.front());
    asking_.add(end.place, fmt::format("the node {} is muted, and has no connected input of type {} to pass through",
                                       in_quotes(muted.node.name), name_of(type)));
    out_.is_faulty = true;
  }

  Diagnostics& asking_;
  WireSources out_;
  int steps_ = 0;
};

/// Connects one port of a node that runs.
void connect_port(NodeDraft& draft, PortWires& port) {
  WireFollower follower(port.diagnostics);
  for (const WireEnd& end : port.wires) follower.follow(*draft.level, end);
  WireSources found = follower.take();
  port.has_faults |= found.is_faulty;
  if (port.has_faults || port.wires.empty()) return;
  const WireEnd& end = port.wires.front();
  const auto refuse = [&](const std::string& message) {
    port.diagnostics.add(end.place, message);
    port.has_faults = true;
  };
  if (found.wires.size() > 1 && !port.port->list) {
    refuse(fmt::format("the port takes one wire, and {} stands for {} (a loop)", in_quotes(end.spelled),
                       found.wires.size()));
  } else if (!found.wires.empty()) {
    draft.node.inputs[port.port->name] = std::move(found.wires);
  } else if (!found.open.empty()) {
    draft.unset.merge(found.open);
  } else if (!port.port->optional) {
    const std::string use = draft.level->use ? draft.level->use->node.name : "";
    refuse(fmt::format("needs a wire, and {} of the node {} is not connected", in_quotes(end.spelled), in_quotes(use)));
  }
}

/// A depth-first walk against the wires, without recursion: a chain of nodes may be long.
class Walk {
 public:
  Walk(const Drafts& drafts, std::vector<Problem>& problems)
      : drafts_(drafts),
        problems_(problems),
        sources_(drafts.size()),
        state_(drafts.size(), State::unseen),
        place_in_path_(drafts.size()) {
    const Positions positions = positions_of(drafts);
    for (size_t i = 0; i < drafts.size(); i++)
      for (const PortWires& p : drafts[i].ports)
        if (const auto wires = drafts[i].node.inputs.find(p.port->name); wires != drafts[i].node.inputs.end())
          for (const Wire& w : wires->second) sources_[i].push_back(positions.at(w.node));
    for (size_t i = 0; i < drafts.size(); i++)
      for (const std::string& asked : drafts[i].asked)
        if (const auto at = positions.find(asked); at != positions.end()) {
          sources_[i].push_back(at->second);
          reads_ = "the wires, and expressions that query nodes, form a cycle: ";
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
      place_in_path_[node] = path.size();
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

  /// Reports a cycle: each step reads the next one, and the last one reads `closing`. The problem's place is that of
  /// the first of them in the document, unless there are more cycles than will be shown.
  void report_cycle(const std::vector<Step>& path, size_t closing) {
    const auto begin = path.begin() + ptrdiff_t(place_in_path_[closing]);
    size_t first = closing;
    if (cycles_++ < most_problems_shown)
      for (auto step = begin; step != path.end(); ++step) first = std::min(first, step->node);
    const GraphNode& node = drafts_[first].node;
    problems_.push_back(
        {node.place, "node " + in_quotes(node.name), reads_ + names_along(begin, path.end()), node.name, node.file});
  }

  /// "a -> c -> b -> a"; the middle of a long cycle is left out.
  std::string names_along(std::vector<Step>::const_iterator begin, std::vector<Step>::const_iterator end) const {
    constexpr ptrdiff_t shown_at_each_end = 10;
    const ptrdiff_t left_out = end - begin - 2 * shown_at_each_end;
    std::string names = drafts_[begin->node].node.name;
    const auto add = [&](std::vector<Step>::const_iterator from, std::vector<Step>::const_iterator to) {
      while (to != from) names += " -> " + drafts_[(--to)->node].node.name;
    };
    if (left_out <= 1) {
      add(begin, end);
    } else {
      add(end - shown_at_each_end, end);
      names += fmt::format(" -> ({} more)", left_out);
      add(begin, begin + shown_at_each_end);
    }
    return names;
  }

  const Drafts& drafts_;
  std::vector<Problem>& problems_;
  std::vector<std::vector<size_t>> sources_;
  std::string reads_ = "the wires form a cycle: ";
  std::vector<State> state_;
  std::vector<size_t> place_in_path_;  ///< of open nodes
  std::vector<size_t> order_;
  size_t cycles_ = 0;
};

}  // namespace

void check_wires(Level& level, std::vector<Problem>& problems, std::vector<Problem>& conversions) {
  const size_t before = problems.size();
  WireChecker checker(*level.graph, level.path, conversions);
  for (const auto& [name, items] : level.items)
    for (const NodeInstance& item : items) {
      const size_t first = problems.size();
      for (PortWires& p : item.draft->ports) checker.check(item.draft->local, p);
      set_node(problems, first, item.draft->node.name);
    }
  for (auto& [name, wires] : level.outputs) checker.check("", wires);
  set_file(problems, before, level.graph->file);
}

std::string wire_fault(const Subgraph& graph, const WireEnd& end, const std::string& reader, const Port& port) {
  std::vector<Problem> ignored;
  const Port* output = nullptr;
  return WireChecker(graph, "", ignored).fault_of(reader, end, port, output);
}

WireSources sources_of(const Level& level, const WireEnd& end, Diagnostics& asking) {
  WireFollower follower(asking);
  follower.follow(level, end);
  return follower.take();
}

void connect(Levels& levels, std::vector<Problem>& problems) {
  size_t wires = 0;
  for (NodeDraft& d : levels.nodes()) {
    const size_t before = problems.size();
    for (PortWires& p : d.ports) connect_port(d, p);
    for (const auto& [port, all] : d.node.inputs) wires += all.size();
    if (wires >= most_wires) {
      problems.push_back(
          {d.node.place, "node " + in_quotes(d.node.name),
           fmt::format("a graph may have fewer than {} wires, counting all iterations of loops", most_wires),
           d.node.name, d.node.file});
      return;
    }
    set_node(problems, before, d.node.name);
    set_file(problems, before, d.node.file);
  }
}

std::vector<size_t> execution_order(const Drafts& drafts, std::vector<Problem>& problems) {
  return Walk(drafts, problems).order();
}

namespace {

/// These nodes and all their sources; if `asks`, also the nodes that their parameters query.
std::set<std::string> closure(const Drafts& drafts, std::vector<std::string> names, bool asks) {
  const Positions positions = positions_of(drafts);
  std::set<std::string> out;
  while (!names.empty()) {
    const auto at = positions.find(names.back());
    names.pop_back();
    if (at == positions.end() || !out.insert(std::string(at->first)).second) continue;
    const NodeDraft& draft = drafts[at->second];
    for (const auto& [port, wires] : draft.node.inputs)
      for (const Wire& wire : wires) names.push_back(wire.node);
    if (asks) names.insert(names.end(), draft.asked.begin(), draft.asked.end());
  }
  return out;
}

}  // namespace

std::set<std::string> needed_nodes(const Drafts& drafts, std::vector<std::string> names) {
  return closure(drafts, std::move(names), false);
}

std::set<std::string> wanted_nodes(const Drafts& drafts, const std::vector<std::string>& only) {
  std::vector<std::string> all, meant;
  for (const NodeDraft& d : drafts) {
    all.push_back(d.node.name);
    if (std::ranges::any_of(only, [&](const std::string& name) { return stands_for(name, d.node.name); }))
      meant.push_back(d.node.name);
  }
  const bool are_there = std::ranges::all_of(only, [&](const std::string& name) {
    return std::ranges::any_of(all, [&](const std::string& node) { return stands_for(name, node); });
  });
  return needed_nodes(drafts, only.empty() || !are_there ? all : meant);
}

std::set<std::string> asked_too(const Drafts& drafts, const std::set<std::string>& nodes) {
  return closure(drafts, {nodes.begin(), nodes.end()}, true);
}

}  // namespace terrazzo
