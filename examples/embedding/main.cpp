// Runs a graph from C++: sets parameters, asks for the plan, watches the run, stops at Ctrl-C, gives a material from
// memory and takes the result back, and registers a node type of its own.
// Usage: embedding GRAPH.json OUT [CACHE]
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>

#include <terrazzo/terrazzo.h>

namespace tz = terrazzo;

namespace {

std::atomic<bool> cancelled = false;

class Watcher : public tz::RunObserver {
 public:
  void finished(const tz::Stage& stage, double seconds) override {
    std::printf("%s took %.2f s\n", stage.node->name.c_str(), seconds);
  }
  void noted(const tz::Stage& stage, const std::string& message) override {
    std::printf("%s: %s\n", stage.node->name.c_str(), message.c_str());
  }
};

/// A node type: pixels are computed when somebody asks for them.
tz::NodeType invert_node() {
  tz::NodeType t;
  t.name = "invert";
  t.category = "image";
  t.summary = "1 minus the value";
  t.inputs = {{.name = "image", .type = tz::ValueType::image}};
  t.outputs = {{.name = "image", .type = tz::ValueType::image}};
  t.persist = tz::Persist::derived;
  t.origin = {"embedding example", "1", {}};
  t.compute = [](tz::NodeContext& node) {
    const tz::ImagePtr in = node.input<tz::Image>("image");
    tz::Operation operation;
    operation.sources = {in};
    operation.compute = [](std::span<const tz::PixelView> sources, const tz::Rect& region, float* out) {
      sources[0].read(region, out);
      for (int64_t i = 0; i < region.area() * sources[0].channels(); i++) out[i] = 1 - out[i];
    };
    node.output("image", tz::Image::computed(in->info(), node.key(), operation));
  };
  return t;
}

/// A checked floor of 128x128, made here.
tz::MaterialPtr floor_in_memory() {
  tz::ImageInfo info;
  info.size = {128, 128};
  info.channels = 1;
  info.semantic = tz::Semantic::height;
  std::vector<float> pixels;
  for (int y = 0; y < 128; y++)
    for (int x = 0; x < 128; x++) pixels.push_back((x / 16 + y / 16) % 2 ? 0.75f : 0.25f + 0.1f * std::sin(float(x)));
  return tz::Material::make("floor", {{"height", tz::Image::from_floats(info, pixels)}});
}

const char* from_memory = R"json({
  "terrazzo": 1,
  "inputs": {"exemplar": {"type": "material"}},
  "outputs": {"result": "@turned"},
  "nodes": {
    "height": {"type": "get_map", "material": "@exemplar", "map": "height"},
    "turned": {"type": "invert", "image": "@height"}
  }
})json";

int run(const std::string& graph, const std::string& out, const std::string& cache) {
  tz::Session session({.cache = cache});

  tz::Job job = tz::Job::open(graph);
  for (const tz::JobParameter& p : job.parameters())
    std::printf("parameter %s: %s\n", p.param.name.c_str(), p.param.help.c_str());
  job.set("out", out);
  const std::vector<tz::Problem> problems = job.check();
  for (const tz::Problem& p : problems) std::fprintf(stderr, "%s\n", tz::describe(graph, p).c_str());
  if (!problems.empty()) return 2;
  const tz::CheckedJob checked = job.checked();
  std::printf("%s\n", session.plan(checked).summary().c_str());
  Watcher watcher;
  const tz::RunResult result = session.run(checked, {.observer = &watcher, .cancelled = &cancelled});
  for (const tz::Failure& f : result.failures) std::fprintf(stderr, "error: %s\n", f.message.c_str());
  std::printf("%s\n", result.summary().c_str());
  if (!result.ok()) return 1;

  tz::register_node_type(invert_node());
  tz::Job in_memory = tz::Job::from_text(from_memory);
  in_memory.give("exemplar", floor_in_memory());
  const tz::RunResult turned = session.run(in_memory.checked(), {.keep = {"turned"}});
  const auto image = std::get<tz::ImagePtr>(turned.kept.at("turned").at("image"));
  std::printf("the inverted height at (20, 4) is %g\n", double(image->read({20, 4, 1, 1})[0]));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: embedding GRAPH.json OUT [CACHE]\n");
    return 2;
  }
  std::signal(SIGINT, [](int) { cancelled = true; });
  try {
    return run(argv[1], argv[2], argc > 3 ? argv[3] : "");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 1;
  }
}
