#pragma once

#include <string_view>
#include <vector>

#include "core/naming/map_words.h"

/// Names that list the maps in a file's channels: OcclusionRoughMetal, metalRoughness, AO_Roughness_Height.
namespace terrazzo {

/// The maps and their channels; none if the text is no such list.
struct PackingName {
  std::vector<WordPart> parts;
  int least_channels = 0;         ///< a file of fewer channels cannot be this
  bool has_full_word = false;     ///< one of the maps is written out: roughness, not rough
  bool all_full_words = false;    ///< all are
  bool begins_with_full = false;  ///< the first is
};

/// `text` in lower case without separators. The maps are in red, green, blue and alpha in this order; roughness and
/// metallic alone in green and blue, as in glTF; metallic and smoothness in red and alpha, as in Unity.
PackingName packing_in(std::string_view text);

}  // namespace terrazzo
