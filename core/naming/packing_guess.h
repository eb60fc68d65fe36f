#pragma once

#include <string>
#include <vector>

#include "core/image/image.h"

/// What a file's pixels say of the maps in it where its name says nothing.
namespace terrazzo {

/// A map that is probably in a channel of a file.
struct GuessedMap {
  Semantic semantic = Semantic::data;
  char channel = 'r';
  bool inverted = false;  ///< smoothness
};

struct PackingGuess {
  std::vector<GuessedMap> maps;  ///< empty if no packing that is in use fits
  std::string grounds{};         ///< what speaks for it, for a note
};

/// Tells the packings ORM (occlusion, roughness, metallic; glTF, Unreal, Godot), RMA, MRA and Unity's MaskMap
/// (metallic, occlusion, detail, smoothness) apart by their channels: metallic is nearly black or nearly white almost
/// everywhere; occlusion is brighter than roughness, white at its brightest, and darker in hollows of the height map,
/// or, if `height` is null, skewed towards white. A channel that is neither is roughness. Rather guesses nothing than
/// wrongly. Looks at no more than 256x256 points. Thread-safe.
PackingGuess guess_packing(const ImagePtr& file, const ImagePtr& height);

/// The correlation of occlusion with how far the height lies above its surroundings: below 0 for a height map that is
/// dark where the surface is high.
double hollow_correlation(const ImagePtr& occlusion, const ImagePtr& height);

}  // namespace terrazzo
