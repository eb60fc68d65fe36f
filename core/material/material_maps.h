#pragma once

#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/material/material_files.h"

/// From the pixels of a file to the map it holds.
namespace terrazzo {

/// Throws Error about `maps` unless a file of so many channels has those that `source` names.
void require_channels(const RecognisedMap& source, int file_channels);

/// The map that `source` describes, taken from its file: the channels that are meant, inverted if need be. Grey maps
/// stored in colour are reduced to one channel, and alpha is left out. Throws Error if the file lacks the channels.
/// What the user should know is added to `notes`.
ImagePtr map_of_file(const RecognisedMap& source, const ImagePtr& file, const std::string& color_space,
                     std::vector<std::string>& notes);

/// An opacity map out of a file's alpha channel; null if there is none or it is 1 everywhere.
ImagePtr opacity_of(const ImagePtr& file);

}  // namespace terrazzo
