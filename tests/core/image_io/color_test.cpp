#include "core/image_io/color.h"

#include <cmath>
#include <cstdlib>
#include <fstream>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

ImagePtr one_pixel(const std::vector<float>& values, const std::string& space) {
  return make_image(
      {1, 1}, int(values.size()), [&](int, int, int c) { return values[c]; }, Semantic::base_color, space);
}

std::vector<float> converted_pixel(const std::vector<float>& values, const std::string& from, const std::string& to) {
  return convert_color(one_pixel(values, from), to)->pixels();
}

void check_near(const std::vector<float>& got, const std::vector<double>& wanted, double tolerance) {
  REQUIRE(got.size() == wanted.size());
  for (size_t i = 0; i < got.size(); i++) CHECK(std::abs(got[i] - wanted[i]) < tolerance);
}

/// Oklab as published, in long double and with the C library's functions.
std::vector<double> reference_oklab(double r, double g, double b) {
  const long double l = cbrtl(0.4122214708L * r + 0.5363325363L * g + 0.0514459929L * b);
  const long double m = cbrtl(0.2119034982L * r + 0.6806995451L * g + 0.1073969566L * b);
  const long double s = cbrtl(0.0883024619L * r + 0.2817188376L * g + 0.6299787005L * b);
  return {double(0.2104542553L * l + 0.7936177850L * m - 0.0040720468L * s),
          double(1.9779984951L * l - 2.4285922050L * m + 0.4505937099L * s),
          double(0.0259040371L * l + 0.7827717662L * m - 0.8086757660L * s)};
}

double decoded(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

/// Sets an environment variable for the time it lives.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) { ::setenv(name, value.c_str(), 1); }
  ~Environment() { ::unsetenv(name_); }

 private:
  const char* name_;
};

}  // namespace

TEST_CASE("the built-in colour spaces convert as their standards say") {
  check_near(converted_pixel({0.5f, 0.0f, 1.0f}, "srgb_texture", "lin_rec709"), {0.2140411405, 0, 1}, 1e-6);
  check_near(converted_pixel({0.2140411405f, 0.0f, 1.0f}, "lin_rec709", "srgb_texture"), {0.5, 0, 1}, 1e-6);
  check_near(converted_pixel({1, 1, 1}, "lin_rec709", "acescg"), {1, 1, 1}, 1e-5);
  check_near(converted_pixel({1, 0, 0}, "lin_rec709", "acescg"), {0.6130974024, 0.0701937225, 0.0206155929}, 1e-6);
}

TEST_CASE("colours come back from every space, alpha never moves") {
  for (const char* space : {"lin_rec709", "acescg", "srgb_texture"})
    for (int k = 0; k < 256; k += 15) {
      const std::vector<float> pixel = {float(k) / 255.0f, float(255 - k) / 255.0f, 0.25f, 0.3f};
      const ImagePtr there = convert_color(one_pixel(pixel, "srgb_texture"), space);
      CHECK(there->info().color_space == space);
      CHECK(there->pixels()[3] == 0.3f);
      const std::vector<float> back = convert_color(there, "srgb_texture")->pixels();
      for (int c = 0; c < 3; c++) CHECK(std::abs(back[c] - pixel[c]) < 2e-6f);
    }
}

TEST_CASE("grey images are converted as grey") {
  CHECK(converted_pixel({0.5f}, "srgb_texture", "lin_rec709")[0] == doctest::Approx(0.2140411405).epsilon(1e-6));
  const std::vector<float> with_alpha = converted_pixel({0.5f, 0.7f}, "srgb_texture", "acescg");
  CHECK(with_alpha[0] == doctest::Approx(0.2140411405).epsilon(1e-5));
  CHECK(with_alpha[1] == 0.7f);
}

TEST_CASE("raw images, and those already there, come back themselves") {
  const ImagePtr raw = one_pixel({0.5f, 0.5f, 0.5f}, "raw"), srgb = one_pixel({0.5f, 0.5f, 0.5f}, "srgb_texture");
  CHECK(convert_color(raw, "acescg") == raw);
  CHECK(convert_color(srgb, "sRGB") == srgb);
  CHECK(convert_color(srgb, "raw")->info().color_space == "raw");
  CHECK(convert_color(srgb, "raw")->pixels() == srgb->pixels());
}

TEST_CASE("a conversion has a digest of its own") {
  const ImagePtr image = one_pixel({0.5f, 0.5f, 0.5f}, "srgb_texture");
  CHECK(convert_color(image, "acescg")->digest() == convert_color(image, "ACEScg")->digest());
  CHECK(convert_color(image, "acescg")->digest() != convert_color(image, "lin_rec709")->digest());
}

TEST_CASE("common other names are understood, unknown ones refused with the known ones") {
  CHECK(canonical_color_space("sRGB") == "srgb_texture");
  CHECK(canonical_color_space("Utility - sRGB - Texture") == "srgb_texture");
  CHECK(canonical_color_space("linear") == "lin_rec709");
  CHECK(canonical_color_space("ACEScg") == "acescg");
  CHECK(canonical_color_space("Raw") == "raw");
  CHECK(color_space_names().size() == 4);
  CHECK_THROWS_WITH_AS(canonical_color_space("srbg"),
                       "there is no colour space \"srbg\" in the built-in configuration, which knows lin_rec709, "
                       "srgb_texture, acescg, raw (did you mean \"srgb\"?)",
                       Error);
}

TEST_CASE("a configuration of one's own replaces the built-in one") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "config.ocio").string();
  std::ofstream(path) << "ocio_profile_version: 1\n"
                         "search_path: luts\n"
                         "roles:\n  default: Raw\n  scene_linear: Linear sRGB\n  reference: Linear sRGB\n"
                         "colorspaces:\n"
                         "  - !<ColorSpace>\n    name: Linear sRGB\n"
                         "  - !<ColorSpace>\n    name: Raw\n    isdata: true\n"
                         "  - !<ColorSpace>\n    name: Doubled\n"
                         "    to_reference: !<MatrixTransform> "
                         "{matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}\n";
  std::filesystem::create_directory(folder.path() / "luts");
  std::ofstream(folder.path() / "luts" / "a.cube") << "x";

  const std::vector<float> doubled =
      convert_color(one_pixel({0.25f, 0.5f, 1}, "lin_rec709"), "Doubled", path)->pixels();
  check_near(doubled, {0.5, 1, 2}, 1e-6);
  CHECK(canonical_color_space("linear", path) == "lin_rec709");
  CHECK_THROWS_AS(canonical_color_space("acescg", path), Error);
  CHECK(color_config_files(path) == std::vector<std::filesystem::path>{path});  // it names no look-up file
  CHECK(color_config_files().empty());
  {
    const Environment ocio("OCIO", path);
    CHECK(canonical_color_space("doubled") == "Doubled");
    CHECK(color_config_files().size() == 1);
    check_near(to_oklab(one_pixel({0.5f, 1, 2}, "Doubled"))->pixels(), reference_oklab(0.25, 0.5, 1), 1e-5);
  }
  CHECK_THROWS_WITH_AS(color_space_names((folder.path() / "missing.ocio").string()), doctest::Contains("missing.ocio"),
                       Error);
}

TEST_CASE("Oklab agrees with the published formulas") {
  const std::vector<std::vector<float>> colors = {
      {1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}, {0.5f, 0.25f, 0.75f}, {0.001f, 0.02f, 0.999f}};
  for (const std::vector<float>& c : colors) {
    check_near(to_oklab(one_pixel(c, "lin_rec709"))->pixels(), reference_oklab(c[0], c[1], c[2]), 1e-6);
    check_near(to_oklab(one_pixel(c, "srgb_texture"))->pixels(),
               reference_oklab(decoded(c[0]), decoded(c[1]), decoded(c[2])), 1e-6);
  }
  check_near(to_oklab(one_pixel({1, 1, 1}, "srgb_texture"))->pixels(), {1, 0, 0}, 1e-6);
}

TEST_CASE("Oklab of an 8-bit value is the same whether looked up or computed") {
  for (int k = 0; k < 256; k++) {
    const float v = float(k) / 255.0f;
    const float beside = std::nextafter(v, 2.0f);
    const float at = to_oklab(one_pixel({v, v, v}, "srgb_texture"))->pixels()[0];
    const float near = to_oklab(one_pixel({beside, beside, beside}, "srgb_texture"))->pixels()[0];
    CHECK(near >= at);
    CHECK(near - at < 1e-5f);
  }
}

TEST_CASE("Oklab has the same bits on every machine") {
  const ImagePtr image = make_image(
      {64, 64}, 3, [](int x, int y, int c) { return float(random_bits(5, x, y, c) >> 40) * 0x1p-24f; },
      Semantic::base_color, "srgb_texture");
  const std::vector<float> lab = to_oklab(image)->pixels();
  CHECK(Hasher().bytes(lab.data(), lab.size() * sizeof(float)).digest().hex() == "594577e61a6e816253679d00c4b7469d");
}

TEST_CASE("the lightness of grey images comes alone") {
  const ImagePtr grey = to_oklab(one_pixel({0.5f, 0.9f}, "srgb_texture"));
  REQUIRE(grey->channels() == 1);
  CHECK(std::abs(grey->pixels()[0] - std::cbrt(decoded(0.5))) < 1e-6);
}
