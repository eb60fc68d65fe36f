#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/image_io/image_file.h"

/// Files of one material whose orientation tags differ: one that was tagged by mistake does not fit the others.
namespace terrazzo {

struct OrientedFile {
  std::string name;             ///< for messages
  std::string map;              ///< that it holds, for messages
  FileInfo info;                ///< its size is that of the upright picture
  std::optional<bool> asked{};  ///< what the user says: whether its tag is ignored
  bool as_stored = false;       ///< its tag is ignored
  bool is_open = false;         ///< the pixels have to tell
  Size size() const;            ///< in pixels, as it is read
};

/// Decides what the user and the shapes of the pictures tell; of files of one tag nothing is doubted. Adds to `notes`.
void settle_orientations_by_shape(std::vector<OrientedFile>& files, std::vector<std::string>& notes);

/// Decides about those that are open. `pictures`: one for each file, as it was read; replaced where the tag is ignored.
/// `read_as_stored` reads a file anew. Adds to `notes`. Throws Error about "path" if the pixels do not tell.
void settle_orientations_by_pixels(std::vector<OrientedFile>& files, std::vector<ImagePtr>& pictures,
                                   const std::function<ImagePtr(size_t)>& read_as_stored,
                                   std::vector<std::string>& notes);

}  // namespace terrazzo
