// A plug-in that does what plug-ins should not; what, says the macro ODD.
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <random>
#include <stdexcept>

#include <terrazzo/terrazzo.h>

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
    tz::ImageInfo info;
    info.size = {8, 8};
    float value = 0.5f;
    if (node.text("how") == "random") value = float(std::random_device()() % 1000) / 1000;
    if (node.text("how") == "clock") value = float(std::chrono::steady_clock::now().time_since_epoch().count() % 1000);
    if (node.text("how") == "variable") value = std::getenv("ODD_VALUE") ? 1 : 0;
    if (node.text("how") == "file") std::ifstream("secret.txt") >> value;
    node.output("image", tz::Image::from_floats(info, std::vector<float>(64, value)));
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
