#pragma once

#include <string>
#include <vector>

#include "core/material/recognised_map.h"
#include "core/naming/file_stems.h"

/// Recognises the maps of a material by file name, in the conventions of ambientCG, Poly Haven, Substance, Quixel
/// Megascans, Unreal, Unity and glTF, and in plain words. Works on lists of names; reads no files. Thread-safe.
namespace terrazzo {

struct Recognition {
  std::vector<RecognisedMap> maps;          ///< in the order of Semantic, then by name
  std::vector<std::string> notes;           ///< what was chosen, inverted, split or left out; one sentence each
  std::vector<std::string> ignored;         ///< unrecognised images
  std::string name{};                       ///< of the requested material, if any
  std::vector<FolderMaterial> materials{};  ///< all materials in the folder, by name
};

/// The user's settings.
struct RecognitionOptions {
  std::string name{};               ///< the requested material, see materials_named; empty: the only one
  std::vector<std::string> data{};  ///< patterns of files to keep as data if their names contain no map keyword
};

/// The last keyword of a name determines the map. Returns no maps if the files form several materials and `wishes`
/// names none or no existing one. Among several files for one map it prefers, in this order: stems shared with most
/// other files, direct maps over packed or inverted ones, OpenGL normals over DirectX, more pixels, and EXR, TIFF and
/// PNG over lossy formats. The order of `files` does not matter.
Recognition recognise_maps(std::vector<MapFile> files, const RecognitionOptions& wishes = {});

}  // namespace terrazzo
