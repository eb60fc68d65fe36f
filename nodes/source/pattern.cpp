#include "core/procedural/pattern.h"

#include <fmt/format.h>

#include "core/node/node.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

std::string palette_names(const PatternType& type) {
  std::string names;
  for (const Palette& p : type.palettes) names += (names.empty() ? "" : ", ") + p.name;
  return names;
}

PatternSpec spec_of(const Params& params) {
  PatternSpec s;
  s.type = std::get<std::string>(params.at("kind"));
  s.size = std::get<Size>(params.at("size"));
  s.seed = uint64_t(std::get<int64_t>(params.at("seed")));
  s.scale = std::get<double>(params.at("scale"));
  s.irregularity = std::get<double>(params.at("irregularity"));
  s.wear = std::get<double>(params.at("wear"));
  s.relief = std::get<double>(params.at("relief"));
  s.palette = std::get<std::string>(params.at("palette"));
  s.tileable = std::get<bool>(params.at("tileable"));
  return s;
}

std::vector<std::string> check_pattern(const Params& params) {
  const PatternType* type = find_pattern_type(std::get<std::string>(params.at("kind")));
  const std::string& palette = std::get<std::string>(params.at("palette"));
  if (!type || find_palette(*type, palette)) return {};
  return {fmt::format("\"palette\": {} come in {}, not in \"{}\"", type->name, palette_names(*type), palette)};
}

std::vector<Param> pattern_params() {
  std::string palettes = "Colour scheme; empty for the kind's first. ";
  std::vector<std::string> names;
  for (const PatternType& p : pattern_types()) {
    names.push_back(p.name);
    palettes += fmt::format("{}: {}; ", p.name, palette_names(p));
  }
  palettes.replace(palettes.size() - 2, 2, ".");
  return {
      {.name = "kind",
       .type = ParamType::choice,
       .fallback = "bricks",
       .help = "The kind of material.",
       .choices = names},
      {.name = "size",
       .type = ParamType::size,
       .fallback = Size{512, 512},
       .help = "Size of every map.",
       .min = 1,
       .max = 16384,
       .unit = "pixels"},
      {.name = "seed",
       .type = ParamType::integer,
       .fallback = int64_t{1},
       .help = "Another number gives another piece of the same material.",
       .min = 0},
      {.name = "scale",
       .type = ParamType::number,
       .fallback = 0.0,
       .help = "Pieces (bricks, stones, yarns ...) across the image; more makes them smaller, 0 takes the kind's "
               "default. Rounded to whole pieces if the material tiles.",
       .min = 0,
       .max = 200},
      {.name = "irregularity",
       .type = ParamType::number,
       .fallback = 0.5,
       .help = "How much pieces differ in position, size and shape; 0 is perfectly regular.",
       .min = 0,
       .max = 1},
      {.name = "wear",
       .type = ParamType::number,
       .fallback = 0.5,
       .help = "Amount of chips, pits, dirt and stains; 0 is new.",
       .min = 0,
       .max = 1},
      {.name = "relief",
       .type = ParamType::number,
       .fallback = 1.0,
       .help = "Depth relative to the kind's natural one. More steepens normals and darkens occlusion.",
       .min = 0,
       .max = 10},
      {.name = "palette", .type = ParamType::text, .fallback = "", .help = palettes},
      {.name = "tileable",
       .type = ParamType::boolean,
       .fallback = true,
       .help = "The material wraps around without a seam."},
      {.name = "labels",
       .type = ParamType::boolean,
       .fallback = false,
       .help = "Adds a map \"labels\": which brick, stone, board ... each pixel belongs to, joints halved between "
               "neighbours: i / (pieces - 1), numbered from the top left; 0 everywhere for weave and gravel."},
  };
}

}  // namespace

NodeType pattern_node() {
  NodeType t;
  t.name = "pattern";
  t.category = "source";
  t.summary = "Generates a procedural material: bricks, stones, cloth ... with matching maps";
  t.help =
      "Describes a surface and derives every map from it: base colour, normal (green up), height, roughness and "
      "ambient occlusion agree at every pixel. Useful as an exemplar when none is at hand, for examples and for "
      "tests; \"labels\" says where its pieces are, so that what an analysis finds can be compared with the truth. "
      "Kinds:";
  for (const PatternType& p : pattern_types())
    t.help += fmt::format(" {} ({}; {:g} across);", p.name, p.summary, p.scale);
  t.help.back() = '.';
  t.outputs = {{.name = "material",
                .type = ValueType::material,
                .help = "base_color, normal, height, roughness, ambient_occlusion, all of one size"}};
  t.params = pattern_params();
  t.persist = Persist::payload;
  t.check = check_pattern;
  t.memory_hint = [](const NodeContext& node) { return size_t(node.size("size").area()) * 15 * sizeof(float); };
  t.infer = [](const Params& params, const InputForecasts&) {
    Forecast out{.maps = {"base_color", "normal", "height", "roughness", "ambient_occlusion"},
                 .possible_maps = Texts{}};
    for (const std::string& map : out.maps) {
      const Semantic semantic = *semantic_from(map);
      const int channels = semantic == Semantic::base_color || semantic == Semantic::normal ? 3 : 1;
      out.images[map] = {.size = std::get<Size>(params.at("size")), .channels = channels, .semantic = semantic};
    }
    if (std::get<bool>(params.at("labels"))) {
      out.maps.push_back("labels");
      out.images["labels"] = values_facts(std::get<Size>(params.at("size")), Semantic::guidance);
    }
    return OutputForecasts{{"material", out}};
  };
  t.compute = [](NodeContext& node) {
    const PatternSpec spec = spec_of(node.params());
    MaterialPtr material = make_pattern(spec, node.task());
    if (node.flag("labels")) {
      std::vector<Map> maps = material->maps();
      maps.push_back({"labels", pattern_labels(spec, node.task())});
      material = Material::make(material->name(), std::move(maps), material->metres());
    }
    node.output("material", material);
  };
  return t;
}

}  // namespace terrazzo
