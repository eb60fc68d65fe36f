#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/filter/workflow.h"
#include "core/image/image_facts.h"
#include "core/image/image_ops.h"
#include "core/image/pixel_space.h"
#include "core/material/map_names.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

const std::string base_name = "base_color";

/// The map besides the base colour that is replaced, and its replacement.
struct Swap {
  std::string from, to;
};

Swap swap_of(const std::string& to) {
  return to == "metallic" ? Swap{"specular", "metallic"} : Swap{"metallic", "specular"};
}

/// A pixel as a colour; grey if it has fewer than three channels.
Vector3d color_at(const float* pixel, int channels) {
  if (channels < 3) return Vector3d(1, 1, 1) * double(pixel[0]);
  return {pixel[0], pixel[1], pixel[2]};
}

void write_color(const Vector3d& color, float* pixel) {
  for (int c = 0; c < 3; c++) pixel[c] = float(color[c]);
}

/// The two maps to convert, in linear light.
struct WorkflowMaps {
  ImagePtr base, other;
};

ImagePtr computed(const NodeContext& node, const WorkflowMaps& sources, const ImageInfo& info,
                  const std::function<void(const Vector3d& base, const Vector3d& other, float* out)>& convert) {
  const ImageInfo base_info = sources.base->info(), other_info = sources.other->info();
  const Digest recipe =
      Hasher().add(map_recipe(node, *sources.base)).add(sources.other->digest()).add(name_of(info.semantic)).digest();
  return pixel_by_pixel(info, recipe, {sources.base, sources.other}, [=](auto in, float* out, int64_t count) {
    const int channels = base_info.channels, others = other_info.channels;
    std::vector<float> base(in[0], in[0] + count * channels), other(in[1], in[1] + count * others);
    to_linear(base_info, base.data(), count);
    to_linear(other_info, other.data(), count);
    for (int64_t i = 0; i < count; i++) {
      const float* b = &base[size_t(i * channels)];
      float* o = out + i * info.channels;
      convert(color_at(b, channels), color_at(&other[size_t(i * others)], others), o);
      if (info.channels == 4) o[3] = b[3];  // alpha stays
    }
    to_stored(info, out, count);
  });
}

ImageInfo color_info(const ImageInfo& base, Semantic semantic) {
  ImageInfo info = base;
  info.semantic = semantic;
  info.channels = semantic == Semantic::base_color && base.channels == 4 ? 4 : 3;
  return info;
}

ImageInfo metallic_info(const ImageInfo& base) {
  ImageInfo info = base;
  info.semantic = Semantic::metallic;
  info.channels = 1;
  info.color_space = "raw";
  return info;
}

/// The new base colour and the new other map.
WorkflowMaps converted(const NodeContext& node, const WorkflowMaps& sources) {
  const ImageInfo& base = sources.base->info();
  if (node.text("to") == "metallic")
    return {
        computed(node, sources, color_info(base, Semantic::base_color),
                 [](const Vector3d& diffuse, const Vector3d& specular, float* out) {
                   write_color(to_metallic({diffuse, specular}).base, out);
                 }),
        computed(node, sources, metallic_info(base), [](const Vector3d& diffuse, const Vector3d& specular, float* out) {
          *out = float(to_metallic({diffuse, specular}).metallic);
        })};
  return {computed(node, sources, color_info(base, Semantic::base_color),
                   [](const Vector3d& color, const Vector3d& metallic, float* out) {
                     write_color(to_specular({color, metallic.x()}).diffuse, out);
                   }),
          computed(node, sources, color_info(base, Semantic::specular),
                   [](const Vector3d& color, const Vector3d& metallic, float* out) {
                     write_color(to_specular({color, metallic.x()}).specular, out);
                   })};
}

/// Colours have to be of the same primaries; the sRGB curve does not change them.
void require_same_primaries(const ImageFacts& base, const ImageFacts& specular) {
  if (!base.color_space || !specular.color_space) return;
  const auto primaries = [](const ImageFacts& image) {
    return *image.color_space == "srgb_texture" ? std::string("lin_rec709") : *image.color_space;
  };
  if (primaries(base) == primaries(specular)) return;
  throw Error("material", fmt::format("expected base_color and specular of the same primaries, found {} and {}; bring "
                                      "one to the other's colour space with \"convert_color\"",
                                      *base.color_space, *specular.color_space));
}

void compute_convert_workflow(NodeContext& node) {
  const auto material = node.input<Material>("material");
  const Swap swap = swap_of(node.text("to"));
  const ImagePtr base = material->find(base_name), other = material->find(swap.from);
  const WorkflowMaps made = converted(node, {base, nearest_at_size(other, base->size())});
  std::vector<Map> maps;
  for (const Map& m : material->maps()) {
    if (m.name == swap.to) continue;
    if (m.name == base_name)
      maps.push_back({base_name, made.base});
    else if (m.name == swap.from)
      maps.push_back({swap.to, made.other});
    else
      maps.push_back(m);
  }
  node.output("material", Material::make(material->name(), std::move(maps)));
}

ImageFacts converted_facts(const ImageFacts& base, Semantic semantic) {
  ImageFacts out{.size = base.size, .semantic = semantic};
  ImageInfo info;
  info.channels = base.channels.value_or(1);
  if (base.channels) out.channels = color_info(info, semantic).channels;
  if (semantic == Semantic::metallic) out.channels = 1;
  return out;
}

OutputForecasts infer_convert_workflow(const Params& params, const InputForecasts& inputs) {
  const Swap swap = swap_of(std::get<std::string>(params.at("to")));
  const Forecast& input = inputs.at("material").front();
  if (input.possible_maps) {
    std::vector<std::string> known = input.maps;
    known.insert(known.end(), input.possible_maps->begin(), input.possible_maps->end());
    require_maps("material", {base_name, swap.from}, known);
  }
  const auto swapped = [&](std::vector<std::string> maps) {
    std::erase(maps, swap.from);
    std::erase(maps, swap.to);
    return maps;
  };
  const ImageFacts base = map_of(input, base_name);
  if (swap.from == "specular") require_same_primaries(base, map_of(input, swap.from));
  Forecast out{.maps = swapped(input.maps), .images = input.images};
  if (input.possible_maps) out.possible_maps = swapped(*input.possible_maps);
  for (const std::string& made : {base_name, swap.to})
    if (std::find(out.maps.begin(), out.maps.end(), made) == out.maps.end()) out.maps.push_back(made);
  out.images.erase(swap.from);
  out.images[swap.to] = converted_facts(base, *semantic_from(swap.to));
  out.images[base_name] = converted_facts(base, Semantic::base_color);
  return {{"material", out}};
}

}  // namespace

NodeType convert_workflow_node() {
  NodeType t;
  t.name = "convert_workflow";
  t.category = "image";
  t.summary = "Converts a material between the metallic and the specular workflow";
  t.help =
      "To metallic: base_color (the diffuse colour) and specular become base_color and metallic. To specular: the way "
      "back. Other maps stay. A dielectric reflects 0.04; the solution is that of glTF's specular-glossiness extension "
      "(Khronos Group 2017), with linear luminance, so that there and back is exact but for rounding, and for metals "
      "darker than 0.04. Colours count in linear light. Gloss and roughness: \"levels\" inverts one to the other, and "
      "\"load_material\" does so by itself.";
  t.inputs = {material_port("material", "the material, with base_color, and specular or metallic")};
  t.outputs = {material_port("material", "the material in the other workflow")};
  t.params = {{.name = "to",
               .type = ParamType::choice,
               .fallback = "metallic",
               .help = "The workflow to convert to. A map of that name that the material already has is replaced.",
               .choices = {"metallic", "specular"}}};
  t.persist = Persist::digest;
  t.infer = infer_convert_workflow;
  t.compute = compute_convert_workflow;
  return t;
}

}  // namespace terrazzo
