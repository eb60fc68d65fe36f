#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/filter/normal_channels.h"

namespace terrazzo {

/// A file, or channels of one, that holds normals.
struct NormalFile {
  std::string place;                         ///< for messages
  std::string map{};                         ///< its name in the material; empty: it is read as a single map
  std::vector<std::string> names{};          ///< of the channels, as the file has them
  std::optional<NormalChannels> channels{};  ///< what the user says
};

struct RebuiltNormals {
  ImagePtr image{};         ///< null: the file has z
  bool uses_alpha = false;  ///< x or y is in the last of two or four channels
};

/// The normals with z rebuilt, where the pixels of `image` have none, which is told in `notes`. `height`: of the same
/// surface; may be null. Throws Error about "path" for what is no normal map, or may be one of several kinds.
RebuiltNormals rebuilt_normals(const ImagePtr& image, const NormalFile& file, const Image* height,
                               std::vector<std::string>& notes);

}  // namespace terrazzo
