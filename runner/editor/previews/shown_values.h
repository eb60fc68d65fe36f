#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/node/value.h"

namespace terrazzo {

/// A picture of a value.
struct ShownImage {
  std::string map;         ///< of a material, or of what else a value consists of; empty if it is the value itself
  ImagePtr image;          ///< may be lazy
  std::string semantic;    ///< of the map; "uv" for a uv map
  Size size;               ///< of the value: drawings of large ones are smaller
  bool has_values = true;  ///< whether pixels are those of the result, rather than a drawing of it
  ImagePtr values{};       ///< of a drawing: the pixels' values, if they have any; of a uv map uv_as_fractions()
  std::optional<Size> exemplar{};  ///< of a uv map
};

/// What a page shows of a value: a material's base colour and its other maps; an image; a uv map in colours; pictures
/// of a report; of features the first map, and the elements in colours; of an appearance or index its main components.
/// The main picture comes first. Drawings have at most `longest` pixels a side. May be empty.
std::vector<ShownImage> shown_images(const Value& value, int longest);

/// A coarse uv map, shown by an exemplar's picture of any size; null if the picture is not of that exemplar's shape.
ImagePtr resolved_coarsely(const UvMap& coarse, const Image& exemplar);

}  // namespace terrazzo
