#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/suggest.h"
#include "core/base/text.h"
#include "core/material/map_names.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

void require_one_each(const std::string& param, const Texts& texts, size_t images) {
  if (texts.empty() || texts.size() == images) return;
  throw Error(param, fmt::format("expected {}, one for each image, or none; found {}", counted(int64_t(images), "text"),
                                 texts.size()));
}

void require_known(const Texts& semantics) {
  for (const std::string& s : semantics)
    if (s != "keep" && !semantic_from(s))
      throw Error("semantics",
                  fmt::format("expected keep or one of {}; found \"{}\"{}", fmt::join(semantic_names, ", "), s,
                              did_you_mean(s, {semantic_names.begin(), semantic_names.end()})));
}

void require_different(const Texts& names) {
  for (size_t i = 0; i < names.size(); i++) {
    if (names[i].empty()) throw Error("names", "expected a name for each map, found an empty one");
    if (std::find(names.begin(), names.begin() + i, names[i]) != names.begin() + i)
      throw Error("names",
                  fmt::format("expected a different name for each map, found \"{0}\" twice; give \"names\", such "
                              "as \"{0}\" and \"{0}_2\"",
                              names[i]));
  }
}

void require_right_texts(const Params& params, size_t images) {
  const Texts &names = std::get<Texts>(params.at("names")), &semantics = std::get<Texts>(params.at("semantics"));
  check_all([&] { require_one_each("names", names, images); }, [&] { require_different(names); },
            [&] { require_one_each("semantics", semantics, images); }, [&] { require_known(semantics); });
}

ImagePtr with_semantic(const ImagePtr& image, const std::string& semantic) {
  if (semantic == "keep") return image;
  ImageInfo info = image->info();
  info.semantic = *semantic_from(semantic);
  return Image::redescribed(image, info);
}

void compute_make_material(NodeContext& node) {
  const auto images = node.list<Image>("images");
  const Texts& semantics = node.texts("semantics");
  std::vector<Map> added;
  for (size_t i = 0; i < images.size(); i++) {
    const ImagePtr image = with_semantic(images[i], semantics.empty() ? "keep" : semantics[i]);
    const Texts& names = node.texts("names");
    added.push_back({names.empty() ? std::string(name_of(image->info().semantic)) : names[i], image});
  }

  const MaterialPtr base = node.optional_input<Material>("material");
  std::vector<Map> maps = base ? base->maps() : std::vector<Map>{};
  for (Map& m : added) {
    const auto same = std::find_if(maps.begin(), maps.end(), [&](const Map& old) { return old.name == m.name; });
    if (same == maps.end())
      maps.push_back(std::move(m));
    else
      same->image = m.image;
  }
  const std::string& name = node.text("name");
  const MaterialPtr material = Material::make(name.empty() && base ? base->name() : name, std::move(maps),
                                              base ? base->metres() : PhysicalSize());
  warn_of_smaller_maps(node, *material, base.get());
  node.output("material", material);
}

/// The facts known about the i-th image, with the semantic that the parameters give it.
ImageFacts added_facts(const Params& params, const InputForecasts& inputs, size_t i) {
  ImageFacts image = image_at(inputs, "images", i);
  const Texts& semantics = std::get<Texts>(params.at("semantics"));
  if (!semantics.empty() && semantics[i] != "keep") image.semantic = semantic_from(semantics[i]);
  return image;
}

OutputForecasts infer_make_material(const Params& params, const InputForecasts& inputs) {
  const size_t count = inputs.at("images").size();
  require_right_texts(params, count);
  const Texts& names = std::get<Texts>(params.at("names"));
  Forecast out{.possible_maps = Texts{}};
  if (const Forecast* base = forecast_at(inputs, "material")) out = *base;
  Texts added;
  for (size_t i = 0; i < count; i++) {
    const ImageFacts image = added_facts(params, inputs, i);
    if (names.empty() && !image.semantic) {
      out.possible_maps.reset();  // the image's unknown semantic will name it
      out.images.clear();         // and it may replace any map
      continue;
    }
    const std::string name = names.empty() ? std::string(name_of(*image.semantic)) : names[i];
    added.push_back(name);
    out.images[name] = image;
    if (std::ranges::find(out.maps, name) == out.maps.end()) out.maps.push_back(name);
    if (out.possible_maps) std::erase(*out.possible_maps, name);
  }
  require_different(added);
  return {{"material", out}};
}

}  // namespace

NodeType make_material_node() {
  NodeType t;
  t.name = "make_material";
  t.category = "image";
  t.summary = "Combines images into a material";
  t.help =
      "With a material connected, its maps come first, and an image of the same name replaces that map: so one map can "
      "be taken out with \"get_map\", changed, and put back.";
  t.inputs = {{.name = "images", .type = ValueType::image, .help = "the maps", .list = true},
              {.name = "material", .type = ValueType::material, .help = "maps to start from", .optional = true}};
  t.outputs = {material_port("material", "the images as one material")};
  t.params = {
      {.name = "name",
       .type = ParamType::text,
       .fallback = "",
       .help = "The material's name; empty keeps the connected material's."},
      {.name = "names",
       .type = ParamType::texts,
       .fallback = Texts{},
       .help = "A name for each image, in their order. Empty: each is named after its semantic."},
      {.name = "semantics",
       .type = ParamType::texts,
       .fallback = Texts{},
       .help = "A semantic for each image (height, roughness, mask, ...), or keep. Empty keeps all."},
  };
  t.persist = Persist::digest;
  t.compute = compute_make_material;
  t.infer = infer_make_material;
  return t;
}

}  // namespace terrazzo
