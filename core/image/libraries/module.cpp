#include <OpenImageIO/filter.h>

#include "core/image/libraries/parts.h"

namespace terrazzo {

std::function<float(float)> oiio_filter_kernel(const std::string& name, float width) {
  const std::shared_ptr<OIIO::Filter1D> kernel(OIIO::Filter1D::create(name, width), OIIO::Filter1D::destroy);
  return [kernel](float distance) { return (*kernel)(distance); };
}

}  // namespace terrazzo

extern "C" __attribute__((visibility("default"))) const terrazzo::ImageLibraries* terrazzo_image_libraries() {
  static constexpr terrazzo::ImageLibraries libraries = {terrazzo::open_with_oiio, terrazzo::create_with_oiio,
                                                         terrazzo::oiio_filter_kernel, terrazzo::load_with_ocio};
  return &libraries;
}
