#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/image/image.h"

/// Which file of a folder is which map of a material, told from the names alone: the conventions of ambientCG, Poly
/// Haven, Substance, Quixel Megascans, Unreal, Unity and glTF, and plain names. Knows no files; works on lists.
namespace terrazzo {

/// A file to be recognised.
struct MapFile {
  std::string name;  ///< with extension, without folder
  Size size;         ///< in pixels; 0x0 if it is not known
  int channels = 0;  ///< 0 if it is not known
};

/// A map, and where it is found.
struct RecognisedMap {
  std::string map;  ///< the semantic's name; "data_cavity", "mask_detail" for further maps
  Semantic semantic = Semantic::data;
  std::string file;
  std::string channels;               ///< "rgb", "r", "a" ...: the file's channels that are the map; empty: all of them
  bool inverted = false;              ///< a gloss or smoothness map: roughness is 1 - value
  std::optional<NormalY> normal_y{};  ///< as the name says, if it does
};

struct Recognition {
  std::vector<RecognisedMap> maps;   ///< in the order of Semantic, then by name
  std::vector<std::string> notes;    ///< what was chosen, inverted, split or left out; one sentence each
  std::vector<std::string> ignored;  ///< images whose names say nothing
};

/// Reads the names. A name is judged by its last telling word. Of several files for one map the one that shares its
/// beginning with most other files is taken, then direct maps before packed or inverted ones, OpenGL normals before
/// DirectX ones, more pixels before fewer, and EXR, TIFF and PNG before lossy formats. The order of `files` does not
/// matter.
Recognition recognise_maps(std::vector<MapFile> files);

/// What one file is, taken by itself; empty if the name says nothing. `prefix`, if given, receives the lower-case
/// beginning of the name, up to the telling word.
std::vector<RecognisedMap> recognise_map(const MapFile& file, std::string* prefix = nullptr);

/// Why an image is no map of its own (a preview, a lower level of detail), as words for a note; empty if it may be one.
std::string reason_to_skip(const std::string& name);

/// The words that `recognise_map` knows for a semantic, comma separated, for messages and documentation.
std::string known_words(Semantic semantic);

/// Whether `name` matches a pattern with the wildcards * and ?; case does not count.
bool matches_pattern(std::string_view name, std::string_view pattern);

}  // namespace terrazzo
