#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

#include <dlfcn.h>

#include "core/base/error.h"
#include "core/image_io/libraries/parts.h"

namespace terrazzo {

namespace {

/// libwebp's simple interface, unchanged since 2010, declared here because nothing else needs the package of its
/// headers. OpenImageIO loads the library.
struct WebpLibrary {
  uint8_t* (*decode)(const uint8_t* data, size_t size, int* width, int* height) = nullptr;
  void (*release)(void* pixels) = nullptr;

  WebpLibrary() {
    void* library = ::dlopen("libwebp.so.7", RTLD_LAZY | RTLD_LOCAL);
    if (!library) return;
    decode = reinterpret_cast<decltype(decode)>(::dlsym(library, "WebPDecodeRGBA"));
    release = reinterpret_cast<decltype(release)>(::dlsym(library, "WebPFree"));
  }
};

}  // namespace

void read_webp(const std::string& path, Size size, void* out) {
  static const WebpLibrary webp;
  if (!webp.decode || !webp.release) throw Error("reading alpha of WebP needs libwebp.so.7; save it as PNG");
  std::ifstream in(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  Size decoded;
  uint8_t* pixels =
      webp.decode(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), &decoded.width, &decoded.height);
  if (!pixels) throw Error("libwebp cannot decode it");
  if (decoded == size) std::memcpy(out, pixels, size_t(size.area()) * 4);
  webp.release(pixels);
  if (decoded != size) throw Error("its frame has another size than the picture; save it as PNG");
}

}  // namespace terrazzo
