#include "core/exemplar/uv_image.h"
#include "core/image_io/image_file.h"
#include "core/node/node.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

void compute_load_uv(NodeContext& node) {
  const std::string& path = node.text("path");
  const std::string& tileable = node.text("tileable");
  const UvWraps wraps{.x = tileable == "x" || tileable == "xy",
                      .y = tileable == "y" || tileable == "xy",
                      .exemplar = node.flag("wraps")};
  const ImagePtr image = read_image(path, {}, [&](const std::string& warning) { node.note(warning); });
  try {
    node.output("uv", uv_from_image(*image, node.input<Material>("exemplar")->size(), wraps));
  } catch (const Error& e) {
    throw Error("path", path + ": " + e.what());
  }
}

}  // namespace

NodeType load_uv_node() {
  NodeType t;
  t.name = "load_uv";
  t.category = "source";
  t.summary = "Reads a uv map that export wrote";
  t.help =
      "For resolving other maps through an earlier result, measuring it with compare, or editing it further. EXR holds "
      "fractions of the exemplar's size, 16-bit PNG and TIFF its pixels; both are read back exactly.";
  t.inputs = {{.name = "exemplar",
               .type = ValueType::material,
               .help = "the exemplar that the uv map was made for, at the analysed size"}};
  t.outputs = {{.name = "uv", .type = ValueType::uv_map, .help = "the exemplar pixel of every output pixel"}};
  t.params = {{.name = "path", .type = ParamType::path, .help = "The image file."},
              {.name = "tileable",
               .type = ParamType::choice,
               .fallback = "none",
               .help = "Directions in which the result wraps around; the file does not say.",
               .choices = {"none", "x", "y", "xy"}},
              {.name = "wraps",
               .type = ParamType::boolean,
               .fallback = false,
               .help = "The exemplar tiles: crossing its border is not a seam."}};
  t.persist = Persist::digest;
  t.files_read = [](const Params& params) {
    return std::vector<std::filesystem::path>{std::get<std::string>(params.at("path"))};
  };
  t.preflight = [](const Params& p, const InputForecasts& inputs) {
    const std::string& path = std::get<std::string>(p.at("path"));
    require_readable_image(path);
    Forecast out{.exemplar = material_size(inputs.at("exemplar").front())};
    try {
      out.size = read_image_info(path).size;
    } catch (const Error&) {
      // compute reports it
    }
    return out;
  };
  t.compute = compute_load_uv;
  return t;
}

}  // namespace terrazzo
