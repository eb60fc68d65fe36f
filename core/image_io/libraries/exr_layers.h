#pragma once

#include <string>
#include <vector>

/// The layers of EXR files.
namespace terrazzo {

/// A group of channels.
struct ExrLayer {
  std::string name;
  int part = 0;
  std::vector<int> channels;  ///< indices in the part, red or x first
};

/// A part of an EXR file: its name, which may be empty, and its channels' names in the order of the file.
struct ExrPart {
  std::string name;
  std::vector<std::string> channels;
};

/// Groups channels into layers by the prefix of their names: the text before the last dot, as programs write layers
/// into one part (OpenEXR's Technical Introduction, "Layers"), or before a final letter (normalX, normalY). If there
/// are several parts, the part's name is put in front of the prefix. Channels of one prefix that form a picture (R, G,
/// B, A), a vector (X, Y, Z or U, V) or a grey value (Y, A) are one layer; every other channel is its own layer:
/// "roughness", or "Z" beside R, G and B. A lone alpha channel without a prefix belongs to the only other layer; beside
/// several layers it is its own.
std::vector<ExrLayer> exr_layers(const std::vector<ExrPart>& parts);

}  // namespace terrazzo
