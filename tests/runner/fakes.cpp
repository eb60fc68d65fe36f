#include "tests/runner/fakes.h"

#include <cmath>
#include <thread>

#include <doctest/doctest.h>
#include <fmt/format.h>

namespace terrazzo::test {

namespace fs = std::filesystem;

ImagePtr number_image(double value) {
  return make_image({1, 1}, 1, [&](int, int, int) { return static_cast<float>(value); });
}

double number_of(const Value& value) {
  return std::get<ImagePtr>(value)->pixels().at(0);
}

namespace {

NodeType make_type(const std::string& name, Persist persist) {
  NodeType t;
  t.name = name;
  t.category = "image";
  t.summary = name;
  t.persist = persist;
  t.outputs = {{.name = "out", .type = ValueType::image}};
  return t;
}

NodeType make_sum(const std::string& name, Persist persist) {
  NodeType t = make_type(name, persist);
  t.inputs = {{.name = "in", .type = ValueType::image, .optional = true, .list = true}};
  t.params = {{.name = "plus", .type = ParamType::number, .fallback = 0.0}};
  return t;
}

NodeType make_sink(const std::string& name) {
  NodeType t = make_type(name, Persist::payload);
  t.category = "sink";
  t.outputs.clear();
  t.inputs = {{.name = "in", .type = ValueType::image, .list = true}};
  t.params = {{.name = "path", .type = ParamType::path}};
  return t;
}

double sum_of(const NodeContext& node) {
  double total = 0;
  for (const ImagePtr& image : node.list<Image>("in")) total += number_of(image);
  return total;
}

}  // namespace

FakeTypes::FakeTypes() {
  number = make_type("number", Persist::payload);
  number.params = {{.name = "value", .type = ParamType::number}};
  number.compute = [](NodeContext& n) { n.output("out", number_image(n.number("value"))); };
  quick = number;
  quick.name = "quick";
  quick.persist = Persist::digest;

  sum = make_sum("sum", Persist::payload);
  sum.compute = [this](NodeContext& n) {
    if (during_sum) during_sum(n);
    n.output("out", number_image(sum_of(n) + n.number("plus")));
  };
  quick_sum = make_sum("quick_sum", Persist::digest);
  quick_sum.compute = sum.compute;
  lazy_sum = make_sum("lazy_sum", Persist::derived);
  lazy_sum.compute = [](NodeContext& n) {
    const double total = sum_of(n) + n.number("plus");
    n.output("out", Image::computed({.size = {1, 1}}, n.key(),
                                    [total](const Rect&, float* out) { *out = static_cast<float>(total); }));
  };
  tens = make_sum("tens", Persist::payload);
  tens.compute = [](NodeContext& n) { n.output("out", number_image(std::floor(sum_of(n) / 10))); };

  file = make_type("file", Persist::digest);
  file.params = {{.name = "path", .type = ParamType::path}};
  file.files_read = [](const Params& p) { return std::vector<fs::path>{std::get<std::string>(p.at("path"))}; };
  file.compute = [](NodeContext& n) {
    n.note("read a number");
    n.output("out", number_image(std::stod(read_text(n.text("path")))));
  };

  write = make_sink("write");
  write.compute = [](NodeContext& n) {
    const fs::path temporary = n.stage(n.text("path"));
    std::string text;
    for (const ImagePtr& image : n.list<Image>("in")) text += fmt::format("{}\n", number_of(image));
    write_text(temporary, text);
  };
  fail = make_sum("fail", Persist::payload);
  fail.compute = [](NodeContext&) { throw Error("in", "these numbers cannot be added"); };
  write_fail = make_sink("write_fail");
  write_fail.compute = [](NodeContext& n) {
    const fs::path temporary = n.stage(n.text("path"));
    write_text(temporary, "half of");
    throw Error("the disk is full at " + temporary.string());
  };
  endless = make_sink("endless");
  endless.compute = [](NodeContext& n) {
    write_text(n.stage(n.text("path")), "half of");
    for (;;) {
      n.task().progress(0.5);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  };

  for (NodeType* t :
       {&number, &quick, &sum, &quick_sum, &lazy_sum, &tens, &file, &write, &fail, &write_fail, &endless}) {
    std::atomic<int>& count = counts_[t->name];
    t->compute = [compute = t->compute, &count](NodeContext& n) {
      count++;
      compute(n);
    };
  }
}

Graph& add(Graph& graph, const std::string& name, const NodeType& type, const Params& params,
           const std::vector<std::string>& in) {
  GraphNode node{.name = name, .type = &type, .params = params, .inputs = {}, .place = {}, .places = {}};
  for (const Param& p : type.params)
    if (p.fallback) node.params.try_emplace(p.name, *p.fallback);
  for (const std::string& wire : in) node.inputs["in"].push_back({wire, "out"});
  graph.nodes.push_back(std::move(node));
  return graph;
}

void set(Graph& graph, const std::string& node, const std::string& param, const ParamValue& value) {
  for (GraphNode& n : graph.nodes)
    if (n.name == node) n.params[param] = value;
}

Graph small_graph(const FakeTypes& types) {
  Graph g;
  add(g, "a", types.number, {{"value", 2.0}});
  add(g, "b", types.number, {{"value", 3.0}});
  return add(g, "total", types.sum, {}, {"a", "b"});
}

RunOptions keeping(const std::vector<std::string>& nodes, Cache* cache) {
  RunOptions options;
  options.targets = {.only = nodes, .keep = nodes};
  options.cache = cache;
  return options;
}

double kept_number(const RunResult& result, const std::string& node) {
  return number_of(result.kept.at(node).at("out"));
}

std::string outcome(const RunResult& result, const std::string& node) {
  constexpr std::array<const char*, 6> names = {"idle", "reused", "run", "failed", "unfinished", "skipped"};
  for (const StageOutcome& s : result.stages)
    if (s.node == node) return names[static_cast<size_t>(s.kind)];
  return "no such node";
}

namespace {

const Stage& stage_of(const Plan& plan, const std::string& node) {
  for (const Stage& s : plan.stages)
    if (s.node->name == node) return s;
  throw std::logic_error("no node " + node);
}

}  // namespace

std::string state(const Plan& plan, const std::string& node) {
  return std::string(name_of(stage_of(plan, node).state));
}

std::string reason(const Plan& plan, const std::string& node) {
  return stage_of(plan, node).reason;
}

}  // namespace terrazzo::test
