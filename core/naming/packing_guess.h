#pragma once

#include <string>
#include <vector>

#include "core/image/image.h"

/// Guesses the maps packed in a file from its pixels.
namespace terrazzo {

/// A map that is probably in a channel of a file.
struct GuessedMap {
  Semantic semantic = Semantic::data;
  char channel = 'r';
  bool inverted = false;  ///< smoothness
};

struct PackingGuess {
  std::vector<GuessedMap> maps;  ///< empty if no common packing fits
  std::string grounds{};         ///< the evidence, for a note
};

/// Distinguishes the packings ORM (occlusion, roughness, metallic; glTF, Unreal, Godot), RMA, MRA and Unity's MaskMap
/// (metallic, occlusion, detail, smoothness) by their channels. Metallic is nearly black or white almost everywhere.
/// Occlusion is brighter than roughness, reaches white, and is darker in hollows of the height map, or, if `height` is
/// null, skewed towards white. Other channels are roughness. Returns nothing rather than an uncertain guess. Uses at
/// most 256x256 points. Thread-safe.
PackingGuess guess_packing(const ImagePtr& file, const ImagePtr& height);

/// The correlation of occlusion with the height relative to its surroundings; negative for an inverted height map.
double hollow_correlation(const ImagePtr& occlusion, const ImagePtr& height);

}  // namespace terrazzo
