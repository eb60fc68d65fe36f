#pragma once

#include <cstdint>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/geometry.h"

/// How large an image file may be: a small file can stand for a picture that no memory holds.
namespace terrazzo {

class TooManyPixels : public Error {
 public:
  using Error::Error;
};

/// At most so many pixels in one image; 0: as many as fit into half of this machine's memory. For the
/// whole process; set it before images are read.
void set_most_pixels(int64_t pixels);

/// Throws TooManyPixels unless an image of this size may be read.
void require_pixels_fit(const std::filesystem::path& path, Size size, int channels);

}  // namespace terrazzo
