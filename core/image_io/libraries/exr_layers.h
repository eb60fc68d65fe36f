#pragma once

#include <string>
#include <vector>

/// The layers of EXR files.
namespace terrazzo {

/// Channels that belong together.
struct ExrLayer {
  std::string name;
  int part = 0;
  std::vector<int> channels;  ///< of the part, red or x first
};

/// A part of an EXR file: its name, which may be empty, and its channels' names in the order of the file.
struct ExrPart {
  std::string name;
  std::vector<std::string> channels;
};

/// Channels are parted by what stands before the last dot of their names, which is how programs write layers into one
/// part (OpenEXR's Technical Introduction, "Layers"), or before a last letter (normalX, normalY). Of several parts each
/// name comes before that. Of the channels of one prefix those of a picture (R, G, B, A), a vector (X, Y, Z or U, V) or
/// a grey value (Y, A) are its layer; each other one is a layer of its own: "roughness", "Z" beside R, G and B.
/// Alpha alone without a prefix belongs to the only other layer; beside several it is a layer of its own.
std::vector<ExrLayer> exr_layers(const std::vector<ExrPart>& parts);

}  // namespace terrazzo
