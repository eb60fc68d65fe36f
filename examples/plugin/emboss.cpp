// A plug-in with one node type: emboss lights a map from one side. See examples/guide/programs.md.
#include <cmath>

#include <terrazzo/terrazzo.h>

namespace tz = terrazzo;

namespace {

tz::NodeType emboss_node() {
  tz::NodeType t;
  t.name = "emboss";
  t.version = 1;
  t.category = "image";
  t.summary = "Lights a map from one side, as if its values were heights";
  t.help = "Each pixel is half grey plus the slope towards the light times the strength. Edges wrap around.";
  t.inputs = {{.name = "image", .type = tz::ValueType::image, .help = "the map; its first channel counts"}};
  t.outputs = {{.name = "image", .type = tz::ValueType::image, .help = "the lit picture, one channel"}};
  t.params = {
      {.name = "angle",
       .type = tz::ParamType::number,
       .fallback = 135.0,
       .help = "Where the light comes from, counter-clockwise from the right.",
       .unit = "degrees"},
      {.name = "strength",
       .type = tz::ParamType::number,
       .fallback = 1.0,
       .help = "How much slopes show.",
       .min = 0,
       .max = 100},
  };
  t.persist = tz::Persist::derived;
  t.compute = [](tz::NodeContext& node) {
    const tz::ImagePtr in = node.input<tz::Image>("image");
    const double radians = node.number("angle") * 3.14159265358979323846 / 180;
    const float x = float(std::cos(radians) * node.number("strength")),
                y = float(std::sin(radians) * node.number("strength"));
    tz::ImageInfo info = in->info();
    info.channels = 1;
    info.semantic = tz::Semantic::data;
    info.color_space = "raw";
    const auto around = [](const tz::Rect& r) { return tz::Rect{r.x - 1, r.y - 1, r.width + 2, r.height + 2}; };
    tz::Operation operation;
    operation.sources = {in};
    operation.reads = [size = in->size(), around](size_t, const tz::Rect& r) {
      return tz::padded_parts(size, around(r), tz::Outside::wrap);
    };
    operation.compute = [=](std::span<const tz::PixelView> sources, const tz::Rect& r, float* out) {
      const std::vector<float> p = tz::read_padded(sources[0], around(r), tz::Outside::wrap);
      const int channels = sources[0].channels(), row = (r.width + 2) * channels;
      for (int j = 0; j < r.height; j++)
        for (int i = 0; i < r.width; i++) {
          const float* at = &p[size_t((j + 1) * row + (i + 1) * channels)];
          out[j * r.width + i] = 0.5f + x * (at[-channels] - at[channels]) + y * (at[row] - at[-row]);
        }
    };
    node.output("image", tz::Image::computed(info, node.key(), operation));
  };
  return t;
}

std::vector<tz::NodeType> types() {
  return {emboss_node()};
}

}  // namespace

TERRAZZO_PLUGIN("emboss", "1.0", types)
