#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/filter/normal_channels.h"

namespace terrazzo {

/// A file, or some channels of one, with normals.
struct NormalFile {
  std::string place;                         ///< for messages
  std::string map{};                         ///< its name in the material; empty: read as a single map
  std::vector<std::string> names{};          ///< channel names in the file
  std::optional<NormalChannels> channels{};  ///< set by the user
};

struct RebuiltNormals {
  ImagePtr image{};         ///< null: the file has z
  bool uses_alpha = false;  ///< x or y is in the last of two or four channels
};

/// Rebuilds z if `image` has none, and adds a note. `height`: of the same surface; may be null. Throws Error about
/// "path" if the image is no normal map, or if its layout is ambiguous.
RebuiltNormals rebuilt_normals(const ImagePtr& image, const NormalFile& file, const Image* height,
                               std::vector<std::string>& notes);

}  // namespace terrazzo
