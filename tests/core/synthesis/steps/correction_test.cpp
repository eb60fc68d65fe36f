#include "core/synthesis/steps/correction.h"

#include <functional>
#include <string>

#include <doctest/doctest.h>
#include <hwy/targets.h>

#include "core/synthesis/synthesize.h"
#include "tests/core/synthesis/fields.h"
#include "tests/core/synthesis/slopes.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr Size exemplar_size{72, 64};

ImagePtr grey(Size size, const std::function<bool(int, int)>& is_light) {
  return make_image(size, 1, [&](int x, int y, int) { return is_light(x, y) ? 1.0f : 0.0f; });
}

IndexPtr index_with(bool wraps, const Lattice& lattice, const ImagePtr& mask = nullptr) {
  const FeaturesPtr features =
      Features::make(exemplar_size, {{wall(exemplar_size), {1.0, 1.0, 1.0}}}, wraps, lattice, mask);
  return make_index(make_appearance(*features, {}, {}, Task()), 3, Task());
}

struct Case {
  const char* name;
  IndexPtr index;
  SynthesisOptions options;
};

/// What takes different ways through the correction of a pixel.
std::vector<Case> cases() {
  const Lattice skew{2, {16.3, 1}, {7.8, 8.2}, 0.6};  // unresolved at coarse levels
  const auto is_left = [](int x, int) { return x < 36; };
  const Control halves{.exemplar = grey(exemplar_size, is_left),
                       .target = grey({50, 46}, [](int x, int y) { return (x / 16 + y / 16) % 2 == 0; }),
                       .mode = Control::Mode::labels};
  return {
      {"plain", index_with(false, {}), {.size = {50, 46}}},
      {"coherence that costs", index_with(false, {}), {.size = {50, 46}, .coherence = 1.5}},
      {"tiling", index_with(true, {}), {.size = {50, 46}, .tile_x = true, .tile_y = true, .jitter = {3, 2, 1}}},
      {"lattice", index_with(false, skew), {.size = {50, 46}}},
      {"courses", index_with(true, {1, {0, 8}, {}, 0.9}), {.size = {50, 48}, .tile_y = true}},
      {"mask", index_with(false, {}, grey(exemplar_size, is_left)), {.size = {50, 46}}},
      {"control", index_with(false, {}), {.size = {50, 46}, .quality = Quality::best, .controls = {halves}}},
  };
}

}  // namespace

TEST_CASE("every instruction set gives the same uv map") {
  for (const Case& c : cases()) {
    CAPTURE(std::string(c.name));
    const Digest expected = synthesize(*c.index, c.options, Task())->digest();
    int targets = 0;
    for (int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1, targets++) {
      const int64_t target = left & -left;
      hwy::SetSupportedTargetsForTest(target);
      CAPTURE(std::string(hwy::TargetName(target)));
      CHECK(synthesize(*c.index, c.options, Task())->digest() == expected);
    }
    hwy::SetSupportedTargetsForTest(0);
    CHECK(targets > 0);
  }
}

TEST_CASE(
    "what goes on around the border of an exemplar that tiles costs nothing, and a wrong pixel there is put right") {
  constexpr int side = 40, from = side - 8;
  const PaddedLevel exemplar = slopes({side, side}, {}, true);
  Field field{{16, 16}, {}};
  for (int y = 0; y < 16; y++)
    for (int x = 0; x < 16; x++) field.pixels.push_back({uint16_t((from + x) % side), uint16_t((from + y) % side)});
  const Field whole = field;
  const CorrectionLevel level = level_of(exemplar, field.size);
  UsagePenalty usage(exemplar.size(), 0, 1, {});
  const auto corrected = [&](Field f) {
    const CorrectionPass pass{.window = &full_window(), .wanted = {0, 0, 16, 16}};
    correct(f, level, pass, usage, Task());
    return f;
  };
  CHECK(corrected(field).pixels == whole.pixels);
  field.at(7, 8) = {20, 5};
  field.at(8, 3) = {4, 30};
  CHECK(corrected(field).pixels == whole.pixels);
}
