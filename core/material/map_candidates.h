#pragma once

#include <string>
#include <vector>

#include "core/material/recognised_map.h"

/// The maps that the files of a folder hold, before it is chosen among them. Reads no files.
namespace terrazzo {

/// A recognised map with what decides between it and others of the same name; smaller is better.
struct Candidate {
  RecognisedMap map;
  RecognisedFile file;  ///< its `stem` is the one that counts
  int stand_in = 0;     ///< 0 the map itself, 1 packed, 2 inverted or a bump map
  Size size{};
  int lossiness = 0;
  bool named_like_material = false;  ///< no word says that it is the base colour

  const Stem& stem() const { return file.stem; }
};

Candidate make_candidate(RecognisedMap map, const RecognisedFile& reading, const MapFile& file);

/// A picture whose name says no map: of several layers the one that the file's name may speak of.
struct UnnamedPicture {
  MapFile file;
  RecognisedFile reading;
};

struct Candidates {
  std::vector<Candidate> maps{};
  std::vector<UnnamedPicture> unnamed{};
  std::vector<std::string> ignored{};  ///< files and layers whose names say no map, as `shown` names them
  std::vector<std::string> notes{};    ///< what was left out, and why
};

/// A layer's name counts before the file's; the file's name speaks of the layer without a name, else of the only one in
/// three or four channels.
Candidates candidates_among(const std::vector<MapFile>& files);

/// "wall.png", "wall.exr (layer Z)".
std::string shown(const MapFile& file);

}  // namespace terrazzo
