#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/image_io/image_file.h"
#include "core/material/material.h"

/// A line in an image file's description that declares the maps it holds. Thread-safe.
///
///     terrazzo: normal green=up color_space=raw metres=2x1.5
///     terrazzo: metallic=r ambient_occlusion=g roughness=1-a color_space=raw
namespace terrazzo {

/// A map in a file.
struct DescribedMap {
  std::string name;  ///< "height", "mask_moss"
  Semantic semantic = Semantic::data;
  std::string channels{};  ///< channels of the file: "rgb", "a"; empty: all
  bool inverted = false;   ///< the file holds 1 - value
};

struct FileDescription {
  std::vector<DescribedMap> maps;
  std::optional<NormalY> normal_y{};
  std::string color_space{};  ///< empty if not stated
  PhysicalSize metres{};      ///< physical size of the surface in the file
};

/// Parses a description. Nullopt if no line begins with "terrazzo: " and names a map. Skips unknown words.
std::optional<FileDescription> file_description(std::string_view description);

/// The colour space that a file states, in its description or in a PNG file's gAMA chunk, as a name of
/// core/image_io/color.h. Empty if there is none, or if `semantic` is no colour. Throws Error about "color_space" for
/// an unknown name.
std::string stated_color_space(const FileInfo& file, Semantic semantic);

/// Formats the line for a description.
std::string description_line(const FileDescription& file);

/// The description of a file that holds one map.
FileDescription description_of(const std::string& map, const ImageInfo& info, PhysicalSize metres);

}  // namespace terrazzo
