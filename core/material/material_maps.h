#pragma once

#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/material/recognised_map.h"

/// Extracts maps from the pixels of a file. Thread-safe.
namespace terrazzo {

/// The number of channels of the map from a file with `file_channels` channels.
int channels_of_map(const RecognisedMap& source, int file_channels);

/// Throws Error about "maps" unless a file with `file_channels` channels has the channels that `source` names.
void require_channels(const RecognisedMap& source, int file_channels);

/// Extracts the map that `source` describes: selects its channels and inverts them if needed. Reduces grey maps stored
/// as colour to one channel and drops alpha. Adds notes for the user. Throws Error if the file lacks the channels.
ImagePtr map_of_file(const RecognisedMap& source, const ImagePtr& file, const std::string& color_space,
                     std::vector<std::string>& notes);

/// Whether the first three channels are equal up to compression noise; false if there are fewer.
bool is_grey(const Image& image);

/// Whether all pixels are equal.
bool is_constant(const Image& image);

/// Whether the image has a varying alpha channel and all other channels are constant.
bool is_only_alpha(const Image& image);

/// A file's alpha channel as a map with this semantic; null if there is none or it is 1 everywhere.
ImagePtr alpha_of(const ImagePtr& file, Semantic semantic, bool inverted = false);

}  // namespace terrazzo
