#pragma once

#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/material/material_files.h"

/// From the pixels of a file to its maps.
namespace terrazzo {

/// Throws Error about "maps" unless a file with `file_channels` channels has those that `source` names.
void require_channels(const RecognisedMap& source, int file_channels);

/// The map that `source` describes: its channels of the file, inverted if it says so. Grey maps stored in colour are
/// reduced to one channel; alpha is dropped. Adds to `notes` what the user should know. Throws Error if the file lacks
/// the channels.
ImagePtr map_of_file(const RecognisedMap& source, const ImagePtr& file, const std::string& color_space,
                     std::vector<std::string>& notes);

/// Whether the first three channels are the same, but for compression noise; false if there are fewer.
bool is_grey(const Image& image);

/// An opacity map out of a file's alpha channel; null if there is none or it is 1 everywhere.
ImagePtr opacity_of(const ImagePtr& file);

}  // namespace terrazzo
