#include "core/image_io/libraries/parts.h"

extern "C" __attribute__((visibility("default"))) const terrazzo::ImageLibraries* terrazzo_image_libraries() {
  static constexpr terrazzo::ImageLibraries libraries = {terrazzo::open_with_oiio, terrazzo::create_with_oiio,
                                                         terrazzo::load_with_ocio};
  return &libraries;
}
