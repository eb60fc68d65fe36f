#pragma once

#include <vector>

#include "core/material/material.h"
#include "core/material/mix_shares.h"

namespace terrazzo {

struct MixOptions {
  Border border = Border::hard;
  double width = 16;      ///< of the border in pixels of the material, half on each side: 0..widest_border
  double softness = 0.1;  ///< see BorderShape; 0..1
  double offset = 0;      ///< -1..1
  bool wraps_x = false, wraps_y = false;  ///< borders continue across the edges
};
inline constexpr double widest_border = 1024;

/// The result of mixing materials.
struct Mix {
  MaterialPtr material;       ///< computed when pulled
  ImagePtr labels;            ///< i / (n - 1) where the i-th of n materials has the largest share
  std::vector<double> parts;  ///< fraction of the map that each material covers
};

/// The material that a value of the map selects: 0 is the first, 1 the last, others are rounded. With two materials,
/// values above 0.5 select the second.
size_t material_at(float value, size_t materials);

/// Shows each material where `map` selects it. The map has one channel and is stretched over the materials.
///
/// Pixels of only one material are kept bit for bit. Across a border colours are mixed in linear light, normals as
/// vectors and normalised, other values as stored (core/image/pixel_space.h); masks, guidance and data come from the
/// material with the largest share. Borders by height compare each material's first height map. The result's heights
/// are those of the visible material, with intruders lowered, so that heights are continuous where the compared heights
/// meet. Heights are clamped to the range found in a sample of rows of all materials.
///
/// Throws Error about "materials" if they differ in size or maps, about "border" if it is by height and a material has
/// no height map of one channel, about "mix" unless the map has one channel. Thread-safe.
Mix mixed(const std::vector<MaterialPtr>& materials, const ImagePtr& map, const MixOptions& options);

/// The size check of mixed(): throws Error about "materials" if `size` differs from the first material's.
void require_one_size(Size first, Size size);
/// The height check of mixed(): throws Error about "border" unless `maps` contain a height map.
void require_height_to_compare(const std::vector<std::string>& maps, const std::string& whose);

}  // namespace terrazzo
