#include "tests/runner/workplace.h"

#include "core/image_io/image_file.h"
#include "tests/runner/fakes.h"

namespace terrazzo::test {

namespace fs = std::filesystem;

void write_picture(const fs::path& path, int step, Semantic semantic, Size size) {
  fs::create_directories(path.parent_path());
  const ImagePtr image = make_image(
      size, 3, [&](int x, int y, int c) { return static_cast<float>((x * step + y * 3 + c * 40) % 256) / 255; },
      semantic, "srgb_texture");
  write_image(*image, path, {.format = FileFormat::png, .depth = Depth::u8}, [](double) {});
}

Workplace::Workplace() {
  write_picture(path / "photo.png", 37);
  write_text(path / "soft.json", R"({
  "terrazzo": 1,
  "summary": "A blurred picture",
  "parameters": {"radius": {"type": "number", "default": 2}, "out": {"type": "path", "default": "out"}},
  "nodes": {
    "photo": {"type": "load_map", "path": "photo.png"},
    "soft":  {"type": "blur", "image": "@photo", "radius": "$radius"},
    "files": {"type": "export", "material": "@soft", "path": "$out/{map}.png"}
  }
})");
}

}  // namespace terrazzo::test
