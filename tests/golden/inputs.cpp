#include "tests/golden/inputs.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "core/base/hash.h"
#include "core/image_io/image_file.h"
#include "test_paths.h"
#include "tests/odd_images.h"
#include "tests/run_node.h"

namespace terrazzo::test {

namespace {

namespace fs = std::filesystem;

void write_map(const fs::path& path, Size size, int channels, const std::function<float(int, int, int)>& value,
               Depth depth = Depth::u8) {
  fs::create_directories(path.parent_path());
  write_image(*make_image(size, channels, value), path, {.format = FileFormat::png, .depth = depth}, [](double) {});
}

/// Bricks of 24 x 12 pixels with joints of 2, each with a shade and a tilt of its own.
struct Wall {
  uint64_t seed = 1;
  double joint_shade = 0.7;

  bool is_joint(int x, int y) const { return y % 12 < 2 || shifted(x, y) % 24 < 2; }
  double height(int x, int y) const {
    if (is_joint(x, y)) return 0.2 + 0.02 * speckle(x, y);
    return 0.6 + 0.2 * of_brick(1, x, y) + 0.01 * (of_brick(2, x, y) - 0.5) * (shifted(x, y) % 24) +
           0.03 * speckle(x, y);
  }
  double color(int x, int y, int c) const {
    if (is_joint(x, y)) return joint_shade - 0.05 * c + 0.05 * speckle(x, y);
    constexpr std::array<double, 3> clay = {0.55, 0.3, 0.22};
    return clay[size_t(c)] * (0.7 + 0.5 * of_brick(0, x, y)) + 0.06 * speckle(x, y);
  }
  double roughness(int x, int y) const { return is_joint(x, y) ? 0.9 : 0.5 + 0.3 * of_brick(3, x, y); }
  /// A component of the encoded unit normal.
  double normal(int x, int y, int c) const {
    const double dx = 8 * (height(x - 1, y) - height(x + 1, y)), dy = 8 * (height(x, y + 1) - height(x, y - 1));
    const double length = std::sqrt(dx * dx + dy * dy + 1);
    return (c == 0 ? dx : c == 1 ? dy : 1) / length * 0.5 + 0.5;
  }

 private:
  static int shifted(int x, int y) { return x + 240 + (y / 12 % 2) * 12; }
  double of_brick(int what, int x, int y) const {
    return unit_double(random_bits(seed, what, y / 12, shifted(x, y) / 24));
  }
  double speckle(int x, int y) const { return unit_double(random_bits(seed, 9, x, y)); }
};

void write_wall(const fs::path& folder, Size size, const Wall& wall) {
  write_map(folder / "base_color.png", size, 3, [&](int x, int y, int c) { return float(wall.color(x, y, c)); });
  write_map(folder / "normal.png", size, 3, [&](int x, int y, int c) { return float(wall.normal(x, y, c)); });
  write_map(
      folder / "height.png", size, 1, [&](int x, int y, int) { return float(wall.height(x, y)); }, Depth::u16);
  write_map(folder / "roughness.png", size, 1, [&](int x, int y, int) { return float(wall.roughness(x, y)); });
  write_map(folder / "ambient_occlusion.png", size, 1,
            [&](int x, int y, int) { return wall.is_joint(x, y) ? 0.5f : 1.0f; });
}

void write_blend(const fs::path& folder, Size size) {
  const auto value = [&](int x, int y) {
    const double along = double(x) / size.width;
    return 0.1 + 0.6 * along + 0.25 * unit_double(random_bits(21, x / 3, y / 2));
  };
  write_map(folder / "base_color.png", size, 3,
            [&](int x, int y, int c) { return float(value(x, y) * (1 - 0.15 * c)); });
  write_map(
      folder / "height.png", size, 1, [&](int x, int y, int) { return float(0.9 - value(x, y)); }, Depth::u16);
}

void write_photo(const fs::path& folder) {
  const fs::path pictures = fs::path(TERRAZZO_SOURCE_DIR) / "examples" / "pictures";
  const ImagePtr picture = read_image(pictures / "gravel-exemplar.jpg", {}, [](const std::string&) {});
  const Rect part{40, 60, 96, 84};
  const std::vector<float> pixels = picture->read(part);
  write_map(folder / "base_color.png", {part.width, part.height}, 3,
            [&](int x, int y, int c) { return pixels[size_t(y * part.width + x) * 3 + size_t(c)]; });
}

void write_steering(const fs::path& folder, Size wall) {
  const auto inside = [](int x, int y, int cx, int cy, int radius) {
    return (x - cx) * (x - cx) + (y - cy) * (y - cy) <= radius * radius;
  };
  write_map(folder / "mask.png", wall, 1, [&](int x, int y, int) { return inside(x, y, 20, 20, 11) ? 0.0f : 1.0f; });
  write_map(folder / "holes.png", wall, 1,
            [&](int x, int y, int) { return inside(x, y, 60, 40, 14) || (y > 70 && y < 73) ? 1.0f : 0.0f; });
  write_map(folder / "labels.png", wall, 3,
            [&](int x, int y, int c) { return (c == 0) == (y < wall.height / 2) || x < 24 ? 1.0f : 0.0f; });
  write_map(folder / "layout.png", {48, 32}, 3,
            [&](int x, int y, int c) { return (c == 0) == inside(x, y, 24, 16, 10) || x < 6 ? 1.0f : 0.0f; });
  write_map(folder / "ramp.png", {40, 30}, 1, [](int x, int y, int) { return float((x + y) / 70.0); });
  write_map(
      folder / "uv.png", {50, 40}, 3,
      [&](int x, int y, int c) {
        const int u = (x * 2 + y / 16) % wall.width, v = (y * 2) % wall.height;
        return c == 2 ? 0.0f : float((c == 0 ? u : v) / 65535.0);
      },
      Depth::u16);
}

std::vector<float> varied(int64_t count, float low, float high) {
  std::vector<float> out;
  for (int64_t i = 0; i < count; i++) out.push_back(low + (high - low) * float(unit_double(random_bits(31, i))));
  return out;
}

void write_odd_files(const fs::path& folder) {
  fs::create_directories(folder);
  Bytes row_of_bits = {0xa5, 0x3c, 0x80}, palette;
  for (int i = 0; i < 4 * 3; i++) palette.push_back(uint8_t(random_bits(32, i)));
  write_bytes(folder / "bits.png", make_png({17, 5}, 1, 0, std::vector<Bytes>(5, row_of_bits)));
  write_bytes(folder / "palette.png", make_png({8, 6}, 2, 3, std::vector<Bytes>(6, Bytes{0x1b, 0xe4}), palette));
  write_bytes(folder / "deep_alpha.png",
              make_png({2, 2}, 16, 4, {{0, 1, 0, 2, 255, 254, 3, 4}, {9, 9, 8, 8, 7, 7, 6, 6}}));
  write_bytes(folder / "one_pixel.png", make_png({1, 1}, 8, 2, {{200, 100, 50}}));
  write_odd(folder / "column.png", {.size = {16, 70}, .channels = 3}, varied(16 * 70 * 3, 0, 1));
  write_odd(folder / "flat.png", {.size = {33, 20}, .channels = 3}, std::vector<float>(33 * 20 * 3, 0.5f));
  write_odd(folder / "rgba.png", {.size = {31, 29}, .channels = 4}, varied(31 * 29 * 4, 0, 1));
  write_odd(folder / "signed.tif", {.size = {9, 7}, .type = "int16"}, varied(63, -1, 1));
  write_odd(folder / "float.tif", {.size = {9, 7}, .type = "float"}, varied(63, -3, 3));
  write_odd(folder / "turned.tif", {.size = {9, 7}, .channels = 3, .attributes = {{"Orientation", 6}}},
            varied(189, 0, 1));
  write_odd(folder / "window.exr",
            {.size = {20, 10}, .channels = 3, .type = "half", .display = {3, 2, 17, 9}, .x = 1, .y = 1, .tile = 16},
            varied(600, 0, 4));
  std::vector<float> wild = varied(24 * 20 * 3, -2, 70000);
  wild[5] = std::numeric_limits<float>::quiet_NaN();
  wild[100] = std::numeric_limits<float>::infinity();
  wild[200] = 1e-30f;
  wild[300] = -0.0f;
  write_odd(folder / "layers.exr",
            {.size = {12, 9}, .channels = 5, .type = "half", .channel_names = {"B", "G", "R", "height.Z", "normal.X"}},
            varied(12 * 9 * 5, 0, 1));
  write_odd(folder / "wild.exr", {.size = {24, 20}, .channels = 3, .type = "float"}, wild);
}

}  // namespace

void write_golden_inputs(const fs::path& folder) {
  constexpr Size wall{96, 84};
  write_wall(folder / "wall", wall, {.seed = 1});
  write_wall(folder / "wall2", {72, 72}, {.seed = 2, .joint_shade = 0.4});
  write_blend(folder / "blend", {80, 64});
  write_photo(folder / "photo");
  write_steering(folder, wall);
  write_odd_files(folder / "odd");
}

}  // namespace terrazzo::test
