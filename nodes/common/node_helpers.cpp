#include "nodes/common/node_helpers.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/exemplar/features.h"
#include "core/image_io/color.h"
#include "core/material/map_names.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

Param edges_param() {
  return {
      .name = "edges",
      .type = ParamType::choice,
      .fallback = "clamp",
      .help =
          "What lies beyond the border: clamp extends the border pixels, wrap repeats the image (for maps that tile).",
      .choices = {"clamp", "wrap"}};
}

Outside edges_of(const NodeContext& node) {
  return node.text("edges") == "wrap" ? Outside::wrap : Outside::clamp;
}

Param normal_y_param() {
  return {.name = "normal_y",
          .type = ParamType::choice,
          .fallback = "up",
          .help = "Green channel of the normals: up as in OpenGL, down as in DirectX.",
          .choices = {"up", "down"}};
}

NormalY normal_y_of(const NodeContext& node) {
  return node.text("normal_y") == "down" ? NormalY::down : NormalY::up;
}

Param height_scale_param() {
  return {.name = "height_scale",
          .type = ParamType::number,
          .fallback = 16.0,
          .help = "How many pixels tall a height of 1 is. More is steeper; negative turns bumps into dents.",
          .min = -10000,
          .max = 10000,
          .unit = "pixels"};
}

Param sample_param(const std::string& name, double fallback, const std::string& help) {
  return {.name = name,
          .type = ParamType::number,
          .fallback = fallback,
          .help = help,
          .min = -largest_sample,
          .max = largest_sample};
}

Port image_port(const std::string& name, const std::string& help) {
  return {.name = name, .type = ValueType::image, .help = help};
}

std::vector<std::string> semantic_choices() {
  return {semantic_names.begin(), semantic_names.end()};
}

Param generated_size_param() {
  return {.name = "size",
          .type = ParamType::size,
          .fallback = Size{512, 512},
          .help = "Size of the image.",
          .min = 1,
          .max = 65536,
          .unit = "pixels"};
}

Param generated_semantic_param(const std::string& fallback, std::vector<std::string> choices) {
  return {.name = "semantic",
          .type = ParamType::choice,
          .fallback = fallback,
          .help = "What the image is used as; decides how it is filtered and written.",
          .choices = std::move(choices)};
}

OutputForecasts forecast_of_generated(const Params& params, int channels) {
  const Semantic semantic = *semantic_from(std::get<std::string>(params.at("semantic")));
  return {{"image", forecast_of_image({std::get<Size>(params.at("size")), channels, semantic,
                                       assumed_color_space(semantic, Depth::u16)})}};
}

ImageInfo generated_info(const NodeContext& node, int channels) {
  ImageInfo info{.size = node.size("size"), .channels = channels, .semantic = *semantic_from(node.text("semantic"))};
  info.color_space = assumed_color_space(info.semantic, Depth::u16);
  return info;
}

ImagePtr constant_image(const NodeContext& node, ImageInfo info, const Numbers& pixel) {
  info.channels = int(pixel.size());
  return Image::computed(info, node.key(),
                         [values = std::vector<float>(pixel.begin(), pixel.end())](const Rect& region, float* out) {
                           for (int64_t i = 0; i < region.area(); i++)
                             out = std::copy(values.begin(), values.end(), out);
                         });
}

Port material_port(const std::string& name, const std::string& help) {
  return {.name = name, .type = ValueType::material, .help = help};
}

void preflight_maps(const std::string& param, const std::vector<std::string>& wanted, const Forecast& material,
                    const std::string& whose) {
  if (!material.possible_maps) return;
  std::vector<Error> certainly_missing;
  for (size_t i = 0; i < wanted.size(); i++) {
    if (std::ranges::find(*material.possible_maps, wanted[i]) != material.possible_maps->end()) continue;
    try {
      require_maps(fmt::format("{}.{}", param, i), {wanted[i]}, material.maps, whose);
    } catch (const Error& e) {
      certainly_missing.push_back(e);
    }
  }
  if (!certainly_missing.empty()) throw Errors(std::move(certainly_missing));
}

void preflight_one_shape(const std::string& port, const InputForecasts& inputs) {
  const Forecast& material = inputs.at(port).front();
  std::vector<std::pair<std::string, Size>> maps;
  for (const std::string& name : material.maps)
    if (const std::optional<Size> size = map_of(material, name).size) maps.emplace_back(name, *size);
  if (!maps.empty()) require_one_shape(port, maps);
}

void require_analysable_maps(const std::string& param, const std::vector<std::string>& wanted,
                             const InputForecasts& inputs) {
  const Forecast& material = inputs.at("material").front();
  check_all([&] { preflight_maps(param, wanted, material); }, [&] { preflight_one_shape("material", inputs); },
            [&] { require_shape("mask", image_at(inputs, "mask"), "the exemplar", material_size(material)); });
}

Digest map_recipe(const NodeContext& node, const Image& map) {
  Hasher h;
  h.add("map of").add(node.type().name).add(node.type().version);
  add_to(h, node.params());
  h.add(map.digest());
  return h.digest();
}

void warn_of_smaller_maps(NodeContext& node, const Material& material, const Material* known) {
  const Size size = material.size();
  std::vector<std::string> smaller;
  for (const Map& m : material.maps()) {
    const bool is_old = known && known->size() == size && known->find(m.name) == m.image;
    if (m.image->size() != size && !is_old)
      smaller.push_back(fmt::format("{} ({})", m.name, describe(m.image->size())));
  }
  if (smaller.empty()) return;
  node.warn(
      fmt::format("the material has {} pixels, the size of its largest map; {} {} scaled up to that. If this is not "
                  "intended, bring the maps to one size",
                  describe(size), fmt::join(smaller, ", "), smaller.size() == 1 ? "is" : "are"));
}

ImagePtr require_map(const std::string& param, const Material& material, const std::string& map) {
  require_maps(param, {map}, names_of(material.maps()));
  return material.find(map);
}

Param metres_param(const std::string& empty) {
  return {.name = "metres",
          .type = ParamType::numbers,
          .fallback = Numbers{},
          .help = "Physical size of the surface that the maps show: width and height, or the width alone. " + empty,
          .min = 0.000001,
          .max = largest_extent,
          .unit = "metres",
          .max_count = 2};
}

PhysicalSize metres_of(const Numbers& given, Size size) {
  if (given.empty()) return {};
  return {given[0], given.size() > 1 ? given[1] : given[0] * size.height / size.width};
}

MaterialPtr with_maps_changed(const MaterialPtr& material, const Texts& maps,
                              const std::function<ImagePtr(const Map&)>& change) {
  require_maps("maps", maps, names_of(material->maps()));
  std::vector<Map> changed = material->maps();
  for (Map& m : changed)
    if (maps.empty() || std::find(maps.begin(), maps.end(), m.name) != maps.end()) m.image = change(m);
  return Material::make(material->name(), std::move(changed), material->metres());
}

std::vector<double> per_channel(const Params& params, const std::string& param, int channels) {
  const Numbers& given = std::get<Numbers>(params.at(param));
  if (given.size() == 1) return std::vector<double>(channels, given.front());
  if (int(given.size()) == channels) return given;
  throw Error(param,
              fmt::format("expected one number, or one for each of the image's channels except alpha, {}; found {}",
                          channels, given.size()));
}

}  // namespace terrazzo
