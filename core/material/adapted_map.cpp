#include "core/material/adapted_map.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/image_ops.h"
#include "core/image_io/color.h"

namespace terrazzo {

namespace {

std::string nth(size_t i, const Material& m) {
  return m.name().empty() ? fmt::format("material {}", i + 1) : fmt::format("material {} (\"{}\")", i + 1, m.name());
}

ImagePtr with_green_reversed(const ImagePtr& normals) {
  ImageInfo info = normals->info();
  info.normal_y = info.normal_y == NormalY::up ? NormalY::down : NormalY::up;
  const Digest recipe = Hasher().add("green reversed").add(normals->digest()).digest();
  return pixel_by_pixel(info, recipe, {normals}, [n = info.channels](auto in, float* out, int64_t count) {
    std::copy_n(in[0], count * n, out);
    for (int64_t i = 0; i < count; i++) out[i * n + 1] = 1 - out[i * n + 1];
  });
}

}  // namespace

ImagePtr adapted_map(const Material& material, size_t i, const std::string& name, const ImageInfo& first) {
  ImagePtr map = material.find(name);
  const ImageInfo& own = map->info();
  if (own.semantic != first.semantic || own.channels != first.channels)
    throw Error("materials",
                fmt::format("expected map \"{}\" to be the same in all materials, {} with {} in the first; "
                            "in {} it is {} with {}",
                            name, name_of(first.semantic), counted(first.channels, "channel"), nth(i, material),
                            name_of(own.semantic), own.channels));
  if (own.semantic == Semantic::normal && own.channels >= 2 && own.normal_y != first.normal_y)
    map = with_green_reversed(map);
  return map->info().color_space == first.color_space ? map : convert_color(map, first.color_space);
}

}  // namespace terrazzo
