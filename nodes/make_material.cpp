#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "core/suggest.h"
#include "core/text.h"
#include "nodes/image_work.h"

namespace terrazzo {

namespace {

void check_count(const std::string& param, const Texts& texts, size_t images) {
  if (texts.empty() || texts.size() == images) return;
  throw Error(param, fmt::format("expected {}, one for each image, or none; found {}", counted(int64_t(images), "text"),
                                 texts.size()));
}

ImagePtr with_semantic(const ImagePtr& image, const std::string& semantic) {
  if (semantic == "keep") return image;
  ImageInfo info = image->info();
  const std::optional<Semantic> known = semantic_from(semantic);
  if (!known)
    throw Error("semantics",
                fmt::format("expected keep or one of {}; found \"{}\"{}", fmt::join(semantic_names, ", "), semantic,
                            did_you_mean(semantic, {semantic_names.begin(), semantic_names.end()})));
  info.semantic = *known;
  return Image::redescribed(image, info);
}

void compute(NodeContext& node) {
  const auto images = node.list<Image>("images");
  const Texts& names = node.texts("names");
  const Texts& semantics = node.texts("semantics");
  check_count("names", names, images.size());
  check_count("semantics", semantics, images.size());

  const MaterialPtr base = node.optional_input<Material>("material");
  std::vector<Map> maps = base ? base->maps() : std::vector<Map>{};
  std::vector<std::string> added;
  for (size_t i = 0; i < images.size(); i++) {
    const ImagePtr image = with_semantic(images[i], semantics.empty() ? "keep" : semantics[i]);
    const std::string name = names.empty() ? std::string(name_of(image->info().semantic)) : names[i];
    if (name.empty()) throw Error("names", "expected a name for each map, found an empty one");
    if (std::find(added.begin(), added.end(), name) != added.end())
      throw Error("names",
                  fmt::format("expected a different name for each map, found \"{}\" twice; give \"names\", such "
                              "as \"{}\" and \"{}_2\"",
                              name, name, name));
    added.push_back(name);
    const auto same = std::find_if(maps.begin(), maps.end(), [&](const Map& m) { return m.name == name; });
    if (same == maps.end())
      maps.push_back({name, image});
    else
      same->image = image;
  }
  const std::string& name = node.text("name");
  const MaterialPtr material = Material::make(name.empty() && base ? base->name() : name, std::move(maps));
  warn_of_smaller_maps(node, *material, base.get());
  node.output("material", material);
}

Forecast foresee(const Params& params, const InputForecasts& inputs) {
  const size_t images = inputs.at("images").size();
  for (const char* param : {"names", "semantics"}) check_count(param, std::get<Texts>(params.at(param)), images);
  const Texts& names = std::get<Texts>(params.at("names"));
  Forecast out{.possible_maps = Texts{}};
  if (const auto base = inputs.find("material"); base != inputs.end())
    out = {.maps = base->second.front().maps, .possible_maps = base->second.front().possible_maps};
  for (const std::string& name : names)
    if (std::find(out.maps.begin(), out.maps.end(), name) == out.maps.end()) out.maps.push_back(name);
  if (names.empty()) out.possible_maps.reset();  // what the images mean will name them
  return out;
}

}  // namespace

NodeType make_material_node() {
  NodeType t;
  t.name = "make_material";
  t.category = "image";
  t.summary = "Puts images together into a material";
  t.help =
      "Makes a material of a list of images. With a material connected, its maps come first, and an image of the same "
      "name takes the place of that map: so one map can be taken out with \"get_map\", changed, and put back.";
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
       .help = "What each image means from now on (height, roughness, mask, ...), or keep. Empty keeps all."},
  };
  t.persist = Persist::digest;
  t.compute = compute;
  t.foresee = foresee;
  return t;
}

}  // namespace terrazzo
