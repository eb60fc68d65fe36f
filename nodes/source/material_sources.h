#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/material/material_files.h"
#include "core/node/node.h"

/// The files of a material, each read once.
namespace terrazzo {

/// A file and, of an EXR file, a layer.
using Place = std::pair<std::string, std::string>;
inline Place place_of(const RecognisedMap& m) {
  return {m.file, m.layer};
}

struct Source {
  ImagePtr image;
  std::vector<std::string> channel_names;  ///< as the file has them; may be empty
};
using Sources = std::map<Place, Source>;

/// Reads the files that hold the maps, several at a time; what readers say becomes notes. Where orientation tags
/// differ, pictures come as they fit each other (nodes/source/turned_files.h).
Sources read_sources(NodeContext& node, const std::filesystem::path& folder, const std::vector<RecognisedMap>& maps);

/// The sizes in which they come, as far as that is known without pixels. Files that cannot be read are left out.
std::map<Place, Size> sizes_of_sources(const std::filesystem::path& folder, const std::vector<RecognisedMap>& maps);

}  // namespace terrazzo
