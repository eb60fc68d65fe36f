#include <algorithm>
#include <cmath>
#include <filesystem>

#include <doctest/doctest.h>

#include "core/image_io/image_file.h"
#include "nodes/common/registry.h"
#include "tests/odd_images.h"
#include "tests/run_node.h"
#include "tests/texts.h"

/// Normal maps that hold x and y alone, in all ways in which files do.
using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

constexpr Size size{64, 48};

float surface(int x, int y) {
  return float(3 * std::sin(x * 0.21 + y * 0.13) + 2 * std::sin(x * 0.17 - y * 0.29) + std::sin(x * 0.05 + y * 0.4));
}

/// Component c of the normal, encoded; `down`: y as in DirectX.
float normal_at(int x, int y, int c, bool down = false) {
  const float u = (surface(x - 1, y) - surface(x + 1, y)) / 2, v = (surface(x, y + 1) - surface(x, y - 1)) / 2;
  const float length = std::sqrt(u * u + v * v + 1), n = (c == 0 ? u : c == 1 ? (down ? -v : v) : 1) / length;
  return n * 0.5f + 0.5f;
}

using Pixel = std::vector<float>;

/// A file whose channels hold what `pixel` makes of x, y and z.
void write(const fs::path& path, const std::function<Pixel(float, float, float)>& pixel,
           const std::string& type = "uint8", const std::vector<std::string>& names = {}, bool down = false) {
  std::vector<float> pixels;
  int channels = 0;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const Pixel p = pixel(normal_at(x, y, 0, down), normal_at(x, y, 1, down), normal_at(x, y, 2));
      channels = int(p.size());
      pixels.insert(pixels.end(), p.begin(), p.end());
    }
  write_odd(path, {.size = size, .channels = channels, .type = type, .channel_names = names}, pixels);
}

void check_normals(const ImagePtr& found, double tolerance, bool down = false) {
  REQUIRE(found);
  REQUIRE(found->channels() == 3);
  const std::vector<float> pixels = found->pixels();
  double worst = 0;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      for (int c = 0; c < 3; c++)
        worst = std::max(
            worst, double(std::abs(pixels[size_t(y * size.width + x) * 3 + size_t(c)] - normal_at(x, y, c, down))));
  CHECK(worst < tolerance);
}

/// Reads the file by both nodes.
void check_file(const std::string& name, double tolerance, const std::string& note, const std::string& interpret = "",
                bool down = false, const fs::path& folder = {}) {
  INFO(name);
  Params one = {{"path", (folder / name).string()}, {"semantic", "normal"}, {"interpret", interpret}};
  const NodeRun map = run_node("load_map", one);
  check_normals(map.get<Image>("image"), tolerance, down);
  CHECK(map.get<Image>("image")->info().color_space == "raw");
  CHECK(map.says(note));
  Params all = {{"path", folder.string()}};
  if (!interpret.empty()) all["interpret"] = TextMap{{"normal", interpret}};
  const NodeRun material = run_node("load_material", all);
  check_normals(material.get<Material>("material")->find("normal"), tolerance, down);
  CHECK(material.says(note));
  CHECK(material.get<Material>("material")->find("normal")->info().normal_y == (down ? NormalY::down : NormalY::up));
  CHECK_FALSE(material.says("warning"));
}

struct Written : TemporaryFolder {
  std::string name;
  Written(std::string file, const std::function<Pixel(float, float, float)>& pixel, const std::string& type = "uint8",
          const std::vector<std::string>& names = {}, bool down = false)
      : name(std::move(file)) {
    write(path() / name, pixel, type, names, down);
  }
  void check(double tolerance, const std::string& note, const std::string& interpret = "", bool down = false) const {
    check_file(name, tolerance, note, interpret, down, path());
  }
  std::string error(const Params& more = {}) const {
    Params params = {{"path", path().string()}};
    for (const auto& [key, value] : more) params[key] = value;
    return error_of("load_material", params);
  }
};

constexpr double eight_bits = 0.02, sixteen_bits = 1e-4, halfs = 0.01;

}  // namespace

TEST_CASE("two channels are x and y, whatever the file calls and orders them, and z is rebuilt") {
  const auto xy = [](float x, float y, float) { return Pixel{x, y}; };
  Written("wall_normal.tif", xy).check(eight_bits, "it has no z; z is rebuilt from x and y");
  Written("wall_nrm.tiff", xy, "uint16").check(sixteen_bits, "it has no z");
  Written("wall_normal.exr", xy, "half", {"R", "G"}).check(halfs, "it has no z");
  Written("wall_normal.exr", xy, "float", {"X", "Y"}).check(1e-5, "it has no z");
  Written("wall_normal.exr",
          [](float x, float y, float) {
            return Pixel{y, x};
          },
          "float", {"Y", "X"})
      .check(1e-5, "it has no z");
  Written("wall_normal.exr",
          [](float x, float y, float) {
            return Pixel{2 * x - 1, 2 * y - 1};
          },
          "float", {"Nx", "Ny"})
      .check(1e-5, "stored as signed numbers");
  Written("wall_normal_dx.tif", xy, "uint16", {}, true).check(sixteen_bits, "it has no z", "", true);
}

TEST_CASE("grey and alpha are told apart by the pixels, or by the user") {
  Written("wall_normal.png", [](float x, float y, float) {
    return Pixel{x, y};
  }).check(eight_bits, "it holds x in grey and y in alpha, told by its pixels");
  Written(
      "wall_normal.png",
      [](float x, float y, float) {
        return Pixel{y, x};
      },
      "uint16")
      .check(sixteen_bits, "it holds y in grey and x in alpha, as DXT5nm, told by its pixels");
  // Copies in all colours.
  Written("wall_normal.png", [](float x, float y, float) {
    return Pixel{y, y, y, x};
  }).check(eight_bits, "as DXT5nm, told by its pixels");
  // Two slopes that no surface has.
  const auto noise = [](float x, float y, float) {
    return Pixel{0.5f + 0.2f * std::sin(7919 * x), 0.5f + 0.2f * std::sin(6133 * y)};
  };
  const Written unclear("wall_normal.png", noise);
  CHECK(contains(unclear.error(),
                 "its pixels do not say which. Say it by `interpret` {\"normal\": \"xy\"} (of synth "
                 "and new: --interpret normal=xy) (x is grey) or \"dxt5nm\" (x is alpha)"));
  const auto first = [&](const char* word) {
    return run_node("load_material", {{"path", unclear.path().string()}, {"interpret", TextMap{{"normal", word}}}})
        .get<Material>("material")
        ->find("normal")
        ->read({5, 5, 1, 1});
  };
  const std::vector<float> xy = first("xy"), yx = first("dxt5nm");
  REQUIRE(xy.size() == 3);
  CHECK(xy[0] == yx[1]);
  CHECK(xy[1] == yx[0]);
  CHECK(xy[2] == yx[2]);
}

TEST_CASE("a height map tells x and y of grey and alpha apart where the normals alone do not") {
  const TemporaryFolder folder;
  const auto groove = [](int x) { return float(std::sin(x * 0.3)); };  // slopes along x alone
  std::vector<float> normals, heights;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      normals.push_back(0.5f + 0.001f * float((x * 7 + y * 13) % 5));
      normals.push_back(0.5f + 0.25f * (groove(x - 1) - groove(x + 1)));
      heights.push_back(0.5f + 0.4f * groove(x));
    }
  write_odd(folder.path() / "wall_normal.png", {.size = size, .channels = 2, .type = "uint16"}, normals);
  CHECK(contains(error_of("load_material", {{"path", folder.path().string()}}), "do not say which"));
  write_odd(folder.path() / "wall_height.png", {.size = size, .channels = 1, .type = "uint16"}, heights);
  const NodeRun run = run_node("load_material", {{"path", folder.path().string()}});
  CHECK(run.says("it holds y in grey and x in alpha"));
}

TEST_CASE("DXT5nm: x in alpha, y in green, whatever fills red and blue") {
  for (const float fill : {0.0f, 1.0f}) {
    Written("wall_normal.png", [=](float x, float y, float) {
      return Pixel{fill, y, 0, x};
    }).check(eight_bits, "it holds x in alpha and y in green, as DXT5nm");
    Written("wall_normal.tga", [=](float x, float y, float) {
      return Pixel{fill, y, y, x};
    }).check(eight_bits, "DXT5nm");
    Written(
        "wall_normal_dx.png",
        [=](float x, float y, float) {
          return Pixel{fill, y, fill, x};
        },
        "uint16", {}, true)
        .check(sixteen_bits, "DXT5nm", "", true);
  }
  // The alpha that held x is lost.
  CHECK(contains(Written("wall_normal.png",
                         [](float, float y, float) {
                           return Pixel{1, y, 0};
                         })
                     .error(),
                 "x was in a channel that is lost"));
  // Height in the alpha of a plain normal map is no DXT5nm.
  const Written plain("wall_normal.png", [](float x, float y, float z) { return Pixel{x, y, z, 0.3f + 0.4f * x}; });
  const NodeRun run = run_node("load_material", {{"path", plain.path().string()}});
  check_normals(run.get<Material>("material")->find("normal"), eight_bits);
  CHECK_FALSE(run.says("rebuilt"));
}

TEST_CASE("an empty blue channel is no z") {
  for (const auto& [blue, said] :
       {std::pair(0.0f, "its blue is 0 throughout"), {1.0f, "its blue is full throughout"}}) {
    Written("wall_normal.png", [=, b = blue](float x, float y, float) {
      return Pixel{x, y, b};
    }).check(eight_bits, said);
    Written("wall_normal.jpg", [=, b = blue](float x, float y, float) { return Pixel{x, y, b}; }).check(0.1, said);
    Written(
        "wall_Normal_DirectX.png",
        [=, b = blue](float x, float y, float) {
          return Pixel{x, y, b, 1};
        },
        "uint16", {}, true)
        .check(sixteen_bits, said, "", true);
  }
  Written("wall_normal.exr",
          [](float x, float y, float) {
            return Pixel{2 * x - 1, 2 * y - 1, 0};
          },
          "float", {"R", "G", "B"})
      .check(1e-5, "its blue is one half throughout");
  Written("wall_normal.png", [](float x, float y, float) {
    return Pixel{x, y, y};
  }).check(eight_bits, "its blue is a copy of its green");
}

TEST_CASE("normals with z come as they are, flat ones and those of gentle slopes too") {
  const auto unchanged = [](const std::string& name, const std::function<Pixel(float, float, float)>& pixel) {
    INFO(name);
    const Written file(name, pixel);
    const ImagePtr plain =
        run_node("load_map", {{"path", (file.path() / name).string()}, {"semantic", "data"}}).get<Image>("image");
    const NodeRun run = run_node("load_map", {{"path", (file.path() / name).string()}, {"semantic", "normal"}});
    CHECK(run.get<Image>("image")->pixels() == plain->pixels());
    CHECK_FALSE(run.says("rebuilt"));
  };
  const auto xyz = [](float x, float y, float z) { return Pixel{x, y, z}; };
  unchanged("wall_normal.png", xyz);
  unchanged("wall_normal.jpg", xyz);
  unchanged("flat_normal.png", [](float, float, float) { return Pixel{128 / 255.0f, 128 / 255.0f, 1}; });
  unchanged("gentle_normal.png", [](float x, float y, float) {
    return Pixel{0.5f + (x - 0.5f) / 20, 0.5f + (y - 0.5f) / 20, 1};
  });
  unchanged("inward_normal.png", [](float x, float y, float z) { return Pixel{x, y, 1 - z}; });
  unchanged("told_normal.png", xyz);
}

TEST_CASE("a grey picture is no normal map") {
  for (const auto& pixel : {std::function<Pixel(float, float, float)>([](float x, float, float) { return Pixel{x}; }),
                            {[](float x, float, float) {
                              return Pixel{x, x, x};
                            }},
                            {[](float x, float, float) {
                              return Pixel{x, 1};
                            }},
                            {[](float x, float, float) {
                              return Pixel{x, x, x, 1};
                            }}}) {
    const Written grey("wall_normal.png", pixel);
    CHECK(contains(grey.error(), "normal: wall_normal.png: it is grey, and so no normal map"));
    CHECK(contains(error_of("load_map", {{"path", (grey.path() / grey.name).string()}, {"semantic", "normal"}}),
                   "wall_normal.png: it is grey, and so no normal map"));
    CHECK(contains(grey.error({{"maps", TextMap{{"normal", grey.name + ":r"}}}}), "it is grey"));
  }
}

TEST_CASE("`maps` names x and y by their channels") {
  const Written file("wall.png", [](float x, float y, float) { return Pixel{0.3f * x, y, 0.7f, x}; });
  const auto read = [&](const char* channels) {
    return run_node("load_material", {{"path", file.path().string()},
                                      {"maps", TextMap{{"normal", std::string("wall.png:") + channels}}}})
        .get<Material>("material")
        ->find("normal");
  };
  check_normals(read("ag"), eight_bits);
}

TEST_CASE("what the user says counts, and is refused where it cannot be") {
  const Written full("wall_normal.png", [](float x, float y, float z) { return Pixel{x, y, z}; });
  const auto say = [&](const char* words) { return full.error({{"interpret", TextMap{{"normal", words}}}}); };
  CHECK(contains(say("dxt5nm"), "it has 3 channels, and \"dxt5nm\" needs alpha"));
  CHECK(contains(full.error({{"interpret", TextMap{{"height", "inverted"}}}}), "there is no map \"height\""));
  const NodeType& type = *find_node_type("load_material");
  Params params = {{"maps", TextMap{}}, {"color_space", "auto"}, {"interpret", TextMap{{"normal", "dxt5"}}}};
  REQUIRE(type.check(params).size() == 1);
  CHECK(contains(type.check(params)[0], "\"interpret.normal\": expected xyz, xy, dxt5nm"));
  CHECK(contains(type.check(params)[0], "did you mean \"dxt5nm\"?"));
  const Written empty("wall_normal.png", [](float x, float y, float) { return Pixel{x, y, 0}; });
  const NodeRun as_is =
      run_node("load_material", {{"path", empty.path().string()}, {"interpret", TextMap{{"normal", "xyz"}}}});
  CHECK(as_is.get<Material>("material")->find("normal")->read({3, 3, 1, 1})[2] == 0);
  CHECK(as_is.says("the normals point into the surface"));
}

TEST_CASE("plans know that normals have three channels") {
  const Written file("wall_normal.tif", [](float x, float y, float) { return Pixel{x, y}; });
  const NodeType& type = *find_node_type("load_material");
  const Params params = {{"path", file.path().string()},
                         {"name", std::string()},
                         {"maps", TextMap{}},
                         {"ignore", Texts{}},
                         {"data", Texts{}}};
  CHECK(type.preflight(params, {}).images.at("normal").channels == 3);
}

TEST_CASE("blue that is another map is a warning, and `interpret` settles it") {
  const auto with_blue = [](float x, float y, float) { return Pixel{x, y, 0.5f + 0.3f * std::sin(7919 * x)}; };
  const Written file("wall_normal.png", with_blue);
  const NodeRun one = run_node("load_map", {{"path", (file.path() / file.name).string()}, {"semantic", "normal"}});
  CHECK(one.says("warning: wall_normal.png: its blue is not the z of red and green"));
  CHECK(one.says("`interpret` \"xy\" rebuilds z from red and green"));
  const NodeRun all = run_node("load_material", {{"path", file.path().string()}});
  CHECK(all.says("warning: normal: wall_normal.png: its blue is not the z"));
  file.check(eight_bits, "it is said to have no z", "xy");
  for (const char* type : {"uint8", "half"}) {
    const Written whole(
        "wall_normal.tif",
        [](float x, float y, float z) {
          return Pixel{x, y, z};
        },
        type);
    CHECK_FALSE(run_node("load_material", {{"path", whole.path().string()}}).says("warning"));
  }
}
