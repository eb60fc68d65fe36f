#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/material/material.h"
#include "core/material/material_files.h"

/// What the pixels of files say against their names, and what hides in alpha channels.
namespace terrazzo {

/// The file, or layer, that holds a map.
using ImageOf = std::function<ImagePtr(const RecognisedMap&)>;

/// Whether `settle_packings` may leave the map out.
bool may_be_left_out(const RecognisedMap& map);

/// Leaves out of `maps` what a packed file does not hold after all: alpha that is full everywhere, and the other map of
/// a grey picture whose name may mean one map alone (brushed_metallic_roughness). Warns of other grey pictures that are
/// taken for packed ones, and tells of channels that are not used.
void settle_packings(const std::vector<RecognisedMap>& sources, const ImageOf& image_of, std::vector<Map>& maps,
                     std::vector<std::string>& notes);

/// Warns of channels that hold something and that no map takes, of the files that names part into channels. `sources`:
/// what names say; `found`: all maps.
void tell_of_unused_channels(const std::vector<RecognisedMap>& sources, const std::vector<RecognisedMap>& found,
                             const ImageOf& image_of, std::vector<std::string>& notes);

/// An opacity map or a mask is in the alpha channel where that alone differs from pixel to pixel.
void settle_only_alpha(RecognisedMap& map, const Image& file, std::vector<std::string>& notes);

/// Leaves out maps whose names say no material and whose pictures have nothing in common with those of the others.
void leave_out_unrelated(const std::vector<RecognisedMap>& sources, std::vector<Map>& maps,
                         std::vector<std::string>& notes);

/// What usually hides in a map's alpha channel: opacity in a base colour's; gloss in that of specular and of metallic
/// maps, as Unity takes them; height in that of normals, as for parallax.
std::optional<Semantic> hidden_in_alpha(const RecognisedMap& map);

/// Adds what hides in the alpha channel of a file to `maps`. A height counts only if the normals follow its slopes.
void add_alpha(const RecognisedMap& source, const ImagePtr& file, std::vector<Map>& maps,
               std::vector<std::string>& notes);

}  // namespace terrazzo
