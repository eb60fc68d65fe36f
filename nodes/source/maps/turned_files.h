#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/image_io/image_file.h"

/// Resolves differing orientation tags among the files of one material: a wrongly tagged file does not fit the others.
namespace terrazzo {

struct OrientedFile {
  std::string name;             ///< for messages
  std::string map;              ///< its map, for messages
  FileInfo info;                ///< its size is that of the upright picture
  std::optional<bool> asked{};  ///< set by the user: whether to ignore the tag
  bool as_stored = false;       ///< its tag is ignored
  bool is_open = false;         ///< undecided until the pixels are compared
  Size size() const;            ///< in pixels, with the decided orientation
};

/// Decides by the user's settings and the images' shapes. Accepts the tags if all are equal. Adds notes.
void settle_orientations_by_shape(std::vector<OrientedFile>& files, std::vector<std::string>& notes);

/// Decides the remaining files by their pixels. `pictures`: one for each file, as read; replaced if the tag is ignored.
/// `read_as_stored` rereads a file. Adds notes. Throws Error about "path" if the pixels are inconclusive.
void settle_orientations_by_pixels(std::vector<OrientedFile>& files, std::vector<ImagePtr>& pictures,
                                   const std::function<ImagePtr(size_t)>& read_as_stored,
                                   std::vector<std::string>& notes);

}  // namespace terrazzo
