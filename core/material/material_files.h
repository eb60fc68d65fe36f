#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/material/file_stems.h"

/// Recognises the maps of a material by file name: the conventions of ambientCG, Poly Haven, Substance, Quixel
/// Megascans, Unreal, Unity and glTF, and plain names. Works on lists; reads no files.
namespace terrazzo {

/// A file to recognise, or a layer of an EXR file.
struct MapFile {
  std::string name;           ///< with extension, without folder
  Size size;                  ///< in pixels; 0x0 if not known
  int channels = 0;           ///< 0 if not known
  std::string description{};  ///< what the file says of itself
  std::string layer{};        ///< see read_layer_infos

  /// As the file would be named if it held this layer alone: "wall_normal.exr" of the layer "normal" in wall.exr.
  std::string telling_name() const;
};

/// A map and its source.
struct RecognisedMap {
  std::string map;  ///< the semantic's name; "data_cavity", "mask_detail" for further maps
  Semantic semantic = Semantic::data;
  std::string file;
  std::string channels;               ///< "rgb", "r", "a" ...: the channels of the file that hold the map; empty: all
  bool inverted = false;              ///< a gloss or smoothness map: roughness is 1 - value
  std::optional<NormalY> normal_y{};  ///< if the name, or whoever describes the file, says it
  std::string color_space{};          ///< if the file is described; empty: as is usual for the map
  std::string said_by{};              ///< who describes the file; empty: only its name
  std::string layer{};                ///< of an EXR file, see read_layer_infos

  /// "orm.png (channel g)", "wall.exr (layer normal)".
  std::string place() const;
};

struct Recognition {
  std::vector<RecognisedMap> maps;          ///< in the order of Semantic, then by name
  std::vector<std::string> notes;           ///< what was chosen, inverted, split or left out; one sentence each
  std::vector<std::string> ignored;         ///< images that are not recognised
  std::string name{};                       ///< of the material, if one was asked for
  std::vector<FolderMaterial> materials{};  ///< all that the files make, by name
};

/// What the user says of the files.
struct MapWishes {
  std::string name{};               ///< which material is meant, see materials_named; empty: there is only one
  std::vector<std::string> data{};  ///< patterns of files to keep as data where their names say no map
};

/// The last known word of a name counts. Files of one material are kept together; where they make several and the
/// wishes do not say which, or name none of them, there are no maps. Of several files for one map it prefers those that
/// share their stem with most other files, then direct maps over packed or inverted ones, OpenGL normals over DirectX,
/// more pixels, and EXR, TIFF and PNG over lossy formats. The order of `files` does not matter.
Recognition recognise_maps(std::vector<MapFile> files, const MapWishes& wishes = {});

/// The maps in one file; empty if the name is not recognised. `stem`, if given, receives that of a recognised name.
std::vector<RecognisedMap> recognise_map(const MapFile& file, Stem* stem = nullptr);

/// Why an image is not a map (a preview, a lower level of detail), for a note; empty if it may be one.
std::string reason_to_skip(const std::string& name);

/// The words that `recognise_map` knows for a semantic, comma separated, for messages and documentation.
std::string known_words(Semantic semantic);

}  // namespace terrazzo
