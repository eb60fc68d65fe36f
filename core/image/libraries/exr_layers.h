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
/// part (OpenEXR's Technical Introduction, "Layers"). Of several parts each name comes before that. Channels without a
/// prefix are one layer, unless they are more than the four of a picture: then each but R, G, B and A is its own.
std::vector<ExrLayer> exr_layers(const std::vector<ExrPart>& parts);

}  // namespace terrazzo
