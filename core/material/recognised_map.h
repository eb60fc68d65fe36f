#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/naming/file_stems.h"
#include "core/naming/interpretation.h"

/// Recognises the maps in one file by its name, the names of its layers, and its description. Reads no files.
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
  Interpretation interpretation{};    ///< what the user says of its pixels
  bool names_no_material = false;     ///< unlike the other files of its material

  /// "orm.png (channel g)", "wall.exr (layer normal)".
  std::string place() const;
};

/// What a file's name says.
struct RecognisedFile {
  std::vector<RecognisedMap> maps{};  ///< empty if the name is not recognised
  Stem stem{};
  Stem stem_with_fillers{};     ///< "texture_wall" of texture_wall_color.png
  bool stem_is_behind = false;  ///< the stem's words stand behind the keyword: color_sand.png
  int further_words = 0;        ///< behind the keyword: 1 of wall_basecolor-boosted.png
  int level_of_detail = 0;      ///< 1 of wall_LOD1_normal.png
  bool told_by_layer = false;   ///< the layer's name says the map, whatever the file's name says
};

RecognisedFile recognise_file(const MapFile& file);

/// The maps in one file; empty if the name is not recognised.
std::vector<RecognisedMap> recognise_map(const MapFile& file);

/// Why an image is not a map (a preview, a mip level), for a note; empty if it may be one.
std::string reason_to_skip(const std::string& name);

/// The words that `recognise_map` knows for a semantic, comma separated, for messages and documentation.
std::string known_words(Semantic semantic);

}  // namespace terrazzo
