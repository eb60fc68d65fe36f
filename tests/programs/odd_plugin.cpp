// A plug-in that does what plug-ins should not; what, says the macro ODD.
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
