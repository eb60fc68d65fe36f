#pragma once

#include <vector>

#include "core/material/material.h"
#include "core/material/mix_shares.h"

namespace terrazzo {

struct MixOptions {
  Border border = Border::hard;
  double width = 16;      ///< of the border, half of it on either side, in pixels of the material: 0..widest_border
  double softness = 0.1;  ///< see BorderShape; 0..1
  double offset = 0;      ///< -1..1
  bool wraps_x = false, wraps_y = false;  ///< borders go on across the edges
};
inline constexpr double widest_border = 1024;

/// Materials laid over each other.
struct Mix {
  MaterialPtr material;       ///< computed when pulled
  ImagePtr labels;            ///< i / (n - 1) where the i-th of n shows most
  std::vector<double> parts;  ///< which part of the map each covers
};

/// Which material a value of the map stands for: values from 0 for the first to 1 for the last, the nearest counts. Of
/// two the second is above 0.5.
size_t material_at(float value, size_t materials);

/// Each material where `map`, one channel stretched over them, says so.
///
/// Where only one shows, its pixels are kept bit for bit. Across a border colours are mixed in linear light, normals as
/// vectors made unit length, other values as stored (core/image/pixel_space.h); masks, guidance and data show the
/// material that shows most. Borders by height compare the first height map of each; the result's heights are those of
/// what shows, intruders as far as they have sunk, so they have no steps where the compared heights meet. Heights count
/// between the least and the greatest in some rows of all materials.
///
/// Throws Error about "materials" if they differ in size or maps, about "border" if heights are to be compared and a
/// material has no height map of one channel, about "mix" unless the map has one channel. Thread-safe.
Mix mixed(const std::vector<MaterialPtr>& materials, const ImagePtr& map, const MixOptions& options);

/// What mixed() says of materials of other sizes: throws Error about "materials" if the `size` of one is not the
/// first's.
void require_one_size(Size first, Size size);
/// What mixed() says of a border by height and these maps; throws Error about "border" unless one of them is a height
/// map.
void require_height_to_compare(const std::vector<std::string>& maps, const std::string& whose);

}  // namespace terrazzo
