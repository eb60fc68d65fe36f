#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/image/image.h"

/// Recognises the maps of a material by file name: the conventions of ambientCG, Poly Haven, Substance, Quixel
/// Megascans, Unreal, Unity and glTF, and plain names. Works on lists; reads no files.
namespace terrazzo {

/// A file to recognise.
struct MapFile {
  std::string name;  ///< with extension, without folder
  Size size;         ///< in pixels; 0x0 if not known
  int channels = 0;  ///< 0 if not known
};

/// A map and its source.
struct RecognisedMap {
  std::string map;  ///< the semantic's name; "data_cavity", "mask_detail" for further maps
  Semantic semantic = Semantic::data;
  std::string file;
  std::string channels;               ///< "rgb", "r", "a" ...: the channels of the file that hold the map; empty: all
  bool inverted = false;              ///< a gloss or smoothness map: roughness is 1 - value
  std::optional<NormalY> normal_y{};  ///< if the name says it
};

struct Recognition {
  std::vector<RecognisedMap> maps;   ///< in the order of Semantic, then by name
  std::vector<std::string> notes;    ///< what was chosen, inverted, split or left out; one sentence each
  std::vector<std::string> ignored;  ///< images that are not recognised
};

/// The last known word of a name counts. Of several files for one map it prefers those that share their prefix with
/// most other files, then direct maps over packed or inverted ones, OpenGL normals over DirectX, more pixels, and EXR,
/// TIFF and PNG over lossy formats. The order of `files` does not matter.
Recognition recognise_maps(std::vector<MapFile> files);

/// The maps in one file; empty if the name is not recognised. `prefix`, if given, receives the lower-case part of the
/// name before the word that counts.
std::vector<RecognisedMap> recognise_map(const MapFile& file, std::string* prefix = nullptr);

/// Why an image is not a map (a preview, a lower level of detail), for a note; empty if it may be one.
std::string reason_to_skip(const std::string& name);

/// The words that `recognise_map` knows for a semantic, comma separated, for messages and documentation.
std::string known_words(Semantic semantic);

/// Whether `name` matches a pattern with the wildcards * and ?; case does not count.
bool matches_pattern(std::string_view name, std::string_view pattern);

}  // namespace terrazzo
