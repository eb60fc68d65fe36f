#pragma once

#include <string>
#include <vector>

#include "core/material/recognised_map.h"
#include "core/naming/file_stems.h"

/// Recognises the maps of a material by file name: the conventions of ambientCG, Poly Haven, Substance, Quixel
/// Megascans, Unreal, Unity and glTF, and plain names. Works on lists; reads no files.
namespace terrazzo {

struct Recognition {
  std::vector<RecognisedMap> maps;          ///< in the order of Semantic, then by name
  std::vector<std::string> notes;           ///< what was chosen, inverted, split or left out; one sentence each
  std::vector<std::string> ignored;         ///< images that are not recognised
  std::string name{};                       ///< of the material, if one was asked for
  std::vector<FolderMaterial> materials{};  ///< all that the files make, by name
};

/// What the user says of the files.
struct RecognitionOptions {
  std::string name{};               ///< which material is meant, see materials_named; empty: there is only one
  std::vector<std::string> data{};  ///< patterns of files to keep as data where their names say no map
};

/// The last known word of a name counts. Files of one material are kept together; where they make several and the
/// wishes do not say which, or name none of them, there are no maps. Of several files for one map it prefers those that
/// share their stem with most other files, then direct maps over packed or inverted ones, OpenGL normals over DirectX,
/// more pixels, and EXR, TIFF and PNG over lossy formats. The order of `files` does not matter.
Recognition recognise_maps(std::vector<MapFile> files, const RecognitionOptions& wishes = {});

}  // namespace terrazzo
