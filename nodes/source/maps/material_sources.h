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

/// A file and, for EXR, a layer.
using SourcePlace = std::pair<std::string, std::string>;
inline SourcePlace place_of(const RecognisedMap& m) {
  return {m.file, m.layer};
}

struct Source {
  ImagePtr image;
  std::vector<std::string> channel_names;  ///< as in the file; may be empty
};
using Sources = std::map<SourcePlace, Source>;

/// Reads the files of the maps in parallel; readers' messages become notes. If orientation tags differ, images are
/// oriented to match each other (nodes/source/maps/turned_files.h).
Sources read_sources(NodeContext& node, const std::filesystem::path& folder, const std::vector<RecognisedMap>& maps);

/// The sizes of the images, as far as they are known without pixels. Leaves out unreadable files.
std::map<SourcePlace, Size> sizes_of_sources(const std::filesystem::path& folder,
                                             const std::vector<RecognisedMap>& maps);

}  // namespace terrazzo
