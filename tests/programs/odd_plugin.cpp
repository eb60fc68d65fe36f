// A plug-in that does what plug-ins should not; what, says the macro ODD.
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <random>
#include <stdexcept>

#include <terrazzo/terrazzo.h>
#include <unistd.h>

namespace tz = terrazzo;

namespace {

tz::NodeType odd_node() {
  tz::NodeType t;
  t.name = "odd";
  t.category = "source";
  t.summary = "Throws";
  t.outputs = {{.name = "image", .type = tz::ValueType::image}};
  t.params = {{.name = "how", .type = tz::ParamType::text, .fallback = "error"}};
  t.compute = [](tz::NodeContext& node) {
    if (node.text("how") == "error") throw tz::Error("how", "it is odd");
    if (node.text("how") == "exception") throw std::runtime_error("out of luck");
    if (node.text("how") == "number") throw 3;
    if (node.text("how") == "nothing") return;
    if (node.text("how") == "exit") std::exit(0);
    if (node.text("how") == "_exit") ::_exit(0);
    if (node.text("how") == "null") return node.output("image", tz::ImagePtr());
    tz::ImageInfo info;
    info.size = {8, 8};
    float value = 0.5f;
    if (node.text("how") == "random") value = float(std::random_device()() % 1000) / 1000;
    if (node.text("how") == "clock") value = float(std::chrono::steady_clock::now().time_since_epoch().count() % 1000);
    if (node.text("how") == "variable") value = std::getenv("ODD_VALUE") ? 1 : 0;
    if (node.text("how") == "file") std::ifstream("secret.txt") >> value;
    if (node.text("how").starts_with("late ")) {
      const auto fail = [how = node.text("how")](const tz::Rect&, float*) {
        if (how == "late exception") throw std::runtime_error("out of luck");
        throw 3;
      };
      return node.output("image", tz::Image::computed(info, node.key(), fail));
    }
    if (node.text("how") == "null source") {
      tz::Operation operation;
      operation.sources = {nullptr};
      return node.output("image", tz::Image::computed(info, node.key(), operation));
    }
    node.output("image", tz::Image::from_floats(info, std::vector<float>(64, value)));
  };
  // What is asked before anything runs can fail as well.
  const auto fails_at = [](const tz::Params& params, const char* moment) {
    if (std::get<std::string>(params.at("how")) == moment) throw 3;
  };
  t.check = [=](const tz::Params& params) { return fails_at(params, "check"), std::vector<std::string>(); };
  t.files_read = [=](const tz::Params& params) {
    return fails_at(params, "files_read"), std::vector<std::filesystem::path>();
  };
  t.preflight = [=](const tz::Params& params, const tz::InputForecasts&) {
    return fails_at(params, "preflight"), tz::Forecast();
  };
  t.infer = [=](const tz::Params& params, const tz::InputForecasts&) {
    return fails_at(params, "infer"), tz::OutputForecasts();
  };
  t.lint = [=](const tz::Params& params, const tz::InputForecasts&) { return fails_at(params, "doubts"), tz::Lints(); };
  t.memory_ahead = [=](const tz::Params& params, const tz::InputForecasts&) {
    return fails_at(params, "memory_ahead"), uint64_t{0};
  };
  return t;
}

std::vector<tz::NodeType> types() {
#if ODD == 1
  throw std::runtime_error("no types today");
#elif ODD == 2
  tz::NodeType t = odd_node();
  t.name = "blur";
  return {t};
#endif
  return {odd_node()};
}

}  // namespace

#if ODD == 3
// It says that it was compiled for another terrazzo.
extern "C" const tz::PluginInfo* terrazzo_plugin() {
  static const tz::PluginInfo info{tz::plugin_abi + 1, sizeof(tz::NodeType), "odd", "1", types};
  return &info;
}
#else
TERRAZZO_PLUGIN("odd", "1", types)
#endif
