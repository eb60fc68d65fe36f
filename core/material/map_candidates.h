#pragma once

#include <string>
#include <vector>

#include "core/material/recognised_map.h"

/// Candidates for the maps of a material among the files of a folder. Reads no files.
namespace terrazzo {

/// A recognised map with the criteria for choosing among maps of the same name; smaller is better.
struct Candidate {
  RecognisedMap map;
  RecognisedFile file;  ///< its `stem` is the effective one
  int stand_in = 0;     ///< 0 the map itself, 1 packed, 2 inverted or a bump map
  Size size{};
  int channels = 0;  ///< of the file; 0 if unknown
  int lossiness = 0;
  bool named_like_material = false;  ///< its name is just the material's, without a word for base colour

  const Stem& stem() const { return file.stem; }
};

Candidate make_candidate(RecognisedMap map, const RecognisedFile& reading, const MapFile& file);

/// A picture whose name contains no map keyword. For several layers, the one that the file's name may refer to.
struct UnnamedPicture {
  MapFile file;
  RecognisedFile reading;
};

struct Candidates {
  std::vector<Candidate> maps{};
  std::vector<UnnamedPicture> unnamed{};
  std::vector<std::string> ignored{};  ///< files and layers without a map keyword, formatted by `shown`
  std::vector<std::string> notes{};    ///< which files were left out, and why
};

/// A layer's name takes precedence over the file's. The file's name refers to the unnamed layer, else to the only layer
/// with three or four channels.
Candidates candidates_among(const std::vector<MapFile>& files);

/// "wall.png", "wall.exr (layer Z)".
std::string shown(const MapFile& file);

}  // namespace terrazzo
