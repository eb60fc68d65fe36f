#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/material/material.h"
#include "core/material/material_files.h"

/// Checks packed files' names against their pixels, and finds maps in alpha channels.
namespace terrazzo {

/// Returns the image of the file or layer that holds a map.
using ImageOf = std::function<ImagePtr(const RecognisedMap&)>;

/// Whether `settle_packings` may remove the map.
bool may_be_left_out(const RecognisedMap& map);

/// Removes maps that a packed file does not really hold: alpha that is 1 everywhere, and the second map of a grey image
/// whose name may mean a single map (brushed_metallic_roughness). Warns of other grey images that are read as packed,
/// and adds notes on unused channels.
void settle_packings(const std::vector<RecognisedMap>& sources, const ImageOf& image_of, std::vector<Map>& maps,
                     std::vector<std::string>& notes);

/// Warns of non-constant channels of packed files that no map uses. `sources`: maps according to the files' names;
/// `found`: all maps.
void tell_of_unused_channels(const std::vector<RecognisedMap>& sources, const std::vector<RecognisedMap>& found,
                             const ImageOf& image_of, std::vector<std::string>& notes);

/// Takes an opacity map or mask from the alpha channel if only that channel varies.
void settle_only_alpha(RecognisedMap& map, const Image& file, std::vector<std::string>& notes);

/// Removes maps whose names lack a material name and whose pixels do not correlate with the other maps.
void leave_out_unrelated(const std::vector<RecognisedMap>& sources, std::vector<Map>& maps,
                         std::vector<std::string>& notes);

/// The map that is commonly stored in another map's alpha channel: opacity with base colour; gloss with specular and
/// metallic, as in Unity; height with normals, as for parallax mapping.
std::optional<Semantic> hidden_in_alpha(const RecognisedMap& map);

/// Adds the map in a file's alpha channel to `maps`. Accepts a height only if the normals follow its slopes.
void add_alpha(const RecognisedMap& source, const ImagePtr& file, std::vector<Map>& maps,
               std::vector<std::string>& notes);

}  // namespace terrazzo
