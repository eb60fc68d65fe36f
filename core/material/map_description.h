#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/image_io/image_file.h"
#include "core/material/material.h"

/// What an image file says in its description of the maps that it holds, on a line of its own. Thread-safe.
///
///     terrazzo: normal green=up color_space=raw metres=2x1.5
///     terrazzo: metallic=r ambient_occlusion=g roughness=1-a color_space=raw
namespace terrazzo {

/// A map in a file.
struct DescribedMap {
  std::string name;  ///< "height", "mask_moss"
  Semantic semantic = Semantic::data;
  std::string channels{};  ///< of the file: "rgb", "a"; empty: all
  bool inverted = false;   ///< the file holds 1 - value
};

struct FileDescription {
  std::vector<DescribedMap> maps;
  std::optional<NormalY> normal_y{};
  std::string color_space{};  ///< empty if it says none
  PhysicalSize metres{};      ///< that the file shows
};

/// Nullopt if none of the lines begins with "terrazzo: " and names a map. What is not known is skipped.
std::optional<FileDescription> file_description(std::string_view description);

/// The colour space that a file says: in its description, if that is of colours, or in a PNG file's gAMA chunk. By a
/// name that core/image_io/color.h knows; empty if it says none, or if `semantic` is no colour. Throws Error about
/// "color_space" for a name that is not known.
std::string stated_color_space(const FileInfo& file, Semantic semantic);

/// The line for a description.
std::string description_line(const FileDescription& file);

/// Of an image that is one map.
FileDescription description_of(const std::string& map, const ImageInfo& info, PhysicalSize metres);

}  // namespace terrazzo
