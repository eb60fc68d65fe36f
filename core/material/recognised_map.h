#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/naming/file_stems.h"
#include "core/naming/interpretation.h"

/// Recognises the maps in one file by its name, the names of its layers, and its description. Reads no files.
namespace terrazzo {

/// An image file or an EXR layer.
struct MapFile {
  std::string name;           ///< with extension, without folder
  Size size;                  ///< in pixels; 0x0 if unknown
  int channels = 0;           ///< 0 if unknown
  std::string description{};  ///< the file's embedded description
  std::string layer{};        ///< see read_layer_infos

  /// The name that the file would have if it held only this layer: "wall_normal.exr" for the layer "normal" of
  /// wall.exr.
  std::string telling_name() const;
};

/// A map and its source.
struct RecognisedMap {
  std::string map;  ///< the semantic's name; "data_cavity", "mask_detail" for further maps
  Semantic semantic = Semantic::data;
  std::string file;
  std::string channels;               ///< "rgb", "r", "a" ...: the channels of the file that hold the map; empty: all
  bool inverted = false;              ///< a gloss or smoothness map: roughness is 1 - value
  std::optional<NormalY> normal_y{};  ///< if the name or a description states it
  std::string color_space{};          ///< if a description states it; empty: the map's default
  std::string said_by{};              ///< the source of the description; empty: only the file's name
  std::string layer{};                ///< of an EXR file, see read_layer_infos
  Interpretation interpretation{};    ///< the user's interpretation of its pixels
  bool names_no_material = false;     ///< its name lacks the material's name, unlike the material's other files

  /// "orm.png (channel g)", "wall.exr (layer normal)".
  std::string place() const;
};

/// The information in a file's name.
struct RecognisedFile {
  std::vector<RecognisedMap> maps{};  ///< empty if the name is not recognised
  Stem stem{};
  Stem stem_with_fillers{};     ///< with filler words: "texture_wall" of texture_wall_color.png
  bool stem_is_behind = false;  ///< the stem follows the keyword: color_sand.png
  int further_words = 0;        ///< after the keyword: 1 in wall_basecolor-boosted.png
  int level_of_detail = 0;      ///< 1 in wall_LOD1_normal.png
  bool told_by_layer = false;   ///< the layer's name determines the map
};

RecognisedFile recognise_file(const MapFile& file);

/// The maps in one file; empty if the name is not recognised.
std::vector<RecognisedMap> recognise_map(const MapFile& file);

/// Why an image is not a map (a preview, a mip level), as a note; empty if it may be one.
std::string reason_to_skip(const std::string& name);

/// The words that `recognise_map` knows for a semantic, comma separated, for messages and documentation.
std::string known_words(Semantic semantic);

}  // namespace terrazzo
