#include "core/synthesis/state/control.h"

#include <cmath>
#include <set>

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "core/base/error.h"
#include "core/procedural/pattern.h"
#include "core/synthesis/synthesize.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr Size exemplar_size{64, 48};

ImagePtr grey(Size size, const std::function<float(int, int)>& value) {
  return make_image(size, 1, [&](int x, int y, int) { return value(x, y); });
}

/// Fine grains on the left, coarse stripes on the right.
const Index& two_sorts() {
  static const IndexPtr made = [] {
    const ImagePtr image = grey(exemplar_size, [](int x, int y) {
      return x < 32 ? float(unit_double(random_bits(1, x, y))) : float((x + y) / 3 % 2) + 0.1f * float(y % 2);
    });
    return make_index(make_appearance(*plain_features(image), {}, {}, Task()), 3, Task());
  }();
  return *made;
}

Control two_labels(const ImagePtr& target) {
  return {.exemplar = grey(exemplar_size, [](int x, int) { return x < 32 ? 0.2f : 0.8f; }),
          .target = target,
          .mode = Control::Mode::labels};
}

bool in_disc(int x, int y) {
  return (x - 48) * (x - 48) + (y - 40) * (y - 40) < 28 * 28;
}

/// The part of the output that shows the label it was painted with.
double landed(const UvMap& uv) {
  int64_t right = 0;
  for (int y = 0; y < uv.size().height; y++)
    for (int x = 0; x < uv.size().width; x++) right += (uv.at(x, y).x >= 32) == in_disc(x, y);
  return double(right) / double(uv.size().area());
}

double mean_square(const UvMap& uv, const std::function<double(int, int)>& has,
                   const std::function<double(int, int)>& wants) {
  double sum = 0;
  for (int y = 0; y < uv.size().height; y++)
    for (int x = 0; x < uv.size().width; x++) sum += std::pow(has(uv.at(x, y).x, uv.at(x, y).y) - wants(x, y), 2);
  return sum / double(uv.size().area());
}

}  // namespace

TEST_CASE("labels land where they are painted, and less strictly the smaller the strength") {
  SynthesisOptions options{.size = {96, 80}};
  const auto share = [&](double strength) {
    Control control = two_labels(grey({96, 80}, [](int x, int y) { return in_disc(x, y) ? 0.9f : 0.0f; }));
    control.strength = strength;
    options.controls = {control};
    return landed(*synthesize(two_sorts(), options, Task()));
  };
  CHECK(share(1) > 0.97);
  CHECK(share(0) < 0.8);
}

TEST_CASE("values follow the target's order whatever its range, at any size, with a mask and tileable") {
  const ImagePtr has = grey(exemplar_size, [](int x, int) { return float(x) / 64; });
  SynthesisOptions options{.size = {70, 60}, .tile_x = true};
  const auto ramp = [](int, int y) { return double(y) / 60; };
  const auto column = [](int x, int) { return double(x) / 64; };
  const double loose = mean_square(*synthesize(two_sorts(), options, Task()), column, ramp);
  for (const Size size : {Size{70, 60}, Size{7, 6}, Size{140, 120}}) {
    options.controls = {{.exemplar = has, .target = grey(size, [size](int, int y) {
                                            return 5 + 0.01f * (float(y) + 0.5f) / float(size.height);
                                          })}};
    const UvMapPtr uv = synthesize(two_sorts(), options, Task());
    CHECK(mean_square(*uv, column, ramp) < 0.2 * loose);
  }
}

TEST_CASE("without matching, values mean the same in exemplar and target") {
  SynthesisOptions options{.size = {60, 60}};
  options.controls = {{.exemplar = grey(exemplar_size, [](int x, int) { return float(x) / 64; }),
                       .target = grey({60, 60}, [](int, int) { return 0.25f; }),
                       .strength = 4,
                       .match = Control::Match::none}};
  const UvMapPtr uv = synthesize(two_sorts(), options, Task());
  double sum = 0;
  for (const ExemplarPixel p : uv->pixels()) sum += p.x;
  CHECK(sum / 3600 == doctest::Approx(16).epsilon(0.25));
}

TEST_CASE("features are not taken apart for the sake of their values, unless the strength is great") {
  // Light and dark blobs; what is wanted everywhere is what only their edges have.
  const Size size{96, 96};
  const ImagePtr blobs = grey(size, [](int x, int y) {
    const double u = x / 2.3 + 0.8 * std::sin(y / 9.0), v = y / 2.3 + 0.8 * std::sin(x / 8.0);
    return float(0.5 + 0.5 * std::sin(u) * std::sin(v) + 0.03 * unit_double(random_bits(2, x, y)));
  });
  const IndexPtr index = make_index(make_appearance(*plain_features(blobs), {}, {}, Task()), 3, Task());
  const auto contrast = [&](double strength) {
    SynthesisOptions options{.size = {128, 128}};
    options.controls = {{.exemplar = blobs,
                         .target = grey({8, 8}, [](int, int) { return 0.5f; }),
                         .strength = strength,
                         .match = Control::Match::none}};
    const auto uv = synthesize(*index, options, Task());
    const float* values = blobs->in_memory();
    const auto has = [&](int u, int v) { return double(values[v * size.width + u]); };
    return mean_square(*uv, has, [](int, int) { return 0.5; });
  };
  double own = 0;
  for (int64_t i = 0; i < size.area(); i++) own += std::pow(blobs->in_memory()[i] - 0.5, 2) / double(size.area());
  CHECK(contrast(1) > 0.5 * own);
  CHECK(contrast(50) < 0.25 * own);
}

TEST_CASE("where a target is smooth, pieces are whole and not one scrap over and over") {
  const MaterialPtr gravel = make_pattern({.type = "gravel", .size = {256, 256}, .tileable = false}, Task());
  const ImagePtr colors = gravel->find("base_color");
  const IndexPtr index = make_index(make_appearance(*plain_features(colors), {}, {}, Task()), 3, Task());
  SynthesisOptions options{.size = {320, 320}};
  options.controls = {{.exemplar = gravel->find("roughness"),
                       .target = grey({16, 16}, [](int x, int y) { return float(-std::hypot(x - 7.5, y - 7.5)); })}};
  const UvMapPtr uv = synthesize(*index, options, Task());
  int seams = 0;
  for (int y = 1; y < 320; y++)
    for (int x = 1; x < 320; x++) {
      const ExemplarPixel p = uv->at(x, y), left = uv->at(x - 1, y), above = uv->at(x, y - 1);
      seams += left.x + 1 != p.x || left.y != p.y || above.x != p.x || above.y + 1 != p.y;
    }
  CHECK(double(seams) / (319 * 319) < 0.25);
}

TEST_CASE("a steered synthesis is the same on any number of threads, and controls count in their result") {
  SynthesisOptions options{.size = {60, 52}};
  std::set<Digest> digests = {synthesize(two_sorts(), options, Task())->digest()};
  options.controls = {two_labels(grey({60, 52}, [](int x, int) { return x < 20 ? 1.f : 0.f; })),
                      {.exemplar = grey({32, 24}, [](int, int y) { return float(y); }),
                       .target = grey({60, 52}, [](int x, int y) { return float(x + y); })}};
  for (const int threads : {1, 2, 4})
    tbb::task_arena(threads).execute([&] { digests.insert(synthesize(two_sorts(), options, Task())->digest()); });
  CHECK(digests.size() == 2);
}

TEST_CASE("controls and kept pixels work together") {
  SynthesisOptions options{.size = exemplar_size};
  for (int y = 0; y < 48; y++)
    for (int x = 0; x < 64; x++) {
      options.kept.pixels.push_back({uint16_t(x), uint16_t(y)});
      options.kept.keep.push_back(y < 20 ? Keep::always : Keep::never);
    }
  options.controls = {two_labels(grey(exemplar_size, [](int x, int) { return x < 32 ? 0.8f : 0.2f; }))};
  const UvMapPtr uv = synthesize(two_sorts(), options, Task());
  int swapped = 0;
  for (int y = 0; y < 48; y++)
    for (int x = 0; x < 64; x++) {
      if (y < 20) REQUIRE(uv->at(x, y) == ExemplarPixel{uint16_t(x), uint16_t(y)});
      swapped += y >= 24 && (uv->at(x, y).x < 32) != (x < 32);
    }
  CHECK(swapped > 24 * 64 * 9 / 10);
}

TEST_CASE("controls that do not suit are refused with what would") {
  const auto refused = [](const Control& control, const char* message) {
    SynthesisOptions options{.size = {40, 40}};
    options.controls = {control};
    CHECK_THROWS_WITH_AS(synthesize(two_sorts(), options, Task()), doctest::Contains(message), Error);
  };
  const ImagePtr one = grey({40, 40}, [](int x, int) { return float(x); });
  refused({.exemplar = one, .target = one}, "aspect ratio of the exemplar, 64x48");
  refused({.exemplar = grey(exemplar_size, [](int x, int) { return float(x); }),
           .target = make_image({40, 40}, 3, [](int, int, int) { return 0.f; })},
          "as many channels");
  refused({.exemplar = grey(exemplar_size, [](int x, int) { return float(x); }),
           .target = one,
           .mode = Control::Mode::labels},
          "at most 32 different labels");
}
