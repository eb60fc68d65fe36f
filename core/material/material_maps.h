#pragma once

#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/material/recognised_map.h"

/// From the pixels of a file to its maps.
namespace terrazzo {

/// How many channels the map has that comes of a file with `file_channels`.
int channels_of_map(const RecognisedMap& source, int file_channels);

/// Throws Error about "maps" unless a file with `file_channels` channels has those that `source` names.
void require_channels(const RecognisedMap& source, int file_channels);

/// The map that `source` describes: its channels of the file, inverted if it says so. Grey maps stored in colour are
/// reduced to one channel; alpha is dropped. Adds to `notes` what the user should know. Throws Error if the file lacks
/// the channels.
ImagePtr map_of_file(const RecognisedMap& source, const ImagePtr& file, const std::string& color_space,
                     std::vector<std::string>& notes);

/// Whether the first three channels are the same, but for compression noise; false if there are fewer.
bool is_grey(const Image& image);

/// Whether every pixel is the same.
bool is_constant(const Image& image);

/// Whether all but the alpha of a file with alpha is the same everywhere, and alpha is not.
bool is_only_alpha(const Image& image);

/// A file's alpha channel as a map of that meaning; null if there is none or it is 1 everywhere.
ImagePtr alpha_of(const ImagePtr& file, Semantic semantic, bool inverted = false);

}  // namespace terrazzo
