#pragma once

#include <string_view>
#include <vector>

#include "core/naming/map_words.h"

/// Names that list the maps in a file's channels: OcclusionRoughMetal, metalRoughness, AO_Roughness_Height.
namespace terrazzo {

/// The maps and their channels; empty if the text is no such list.
struct PackingName {
  std::vector<WordPart> parts;
  int least_channels = 0;         ///< a file of fewer channels cannot be this
  bool has_full_word = false;     ///< at least one map is spelled out: roughness, not rough
  bool all_full_words = false;    ///< all maps are spelled out
  bool begins_with_full = false;  ///< the first map is spelled out
};

/// `text`: in lower case without separators. Maps are assigned to red, green, blue and alpha in order, except that only
/// roughness and metallic go to green and blue, as in glTF, and metallic and smoothness to red and alpha, as in Unity.
PackingName packing_in(std::string_view text);

}  // namespace terrazzo
