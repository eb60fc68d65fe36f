#include "runner/engine/held_memory.h"

#include <doctest/doctest.h>

#include "core/exemplar/appearance.h"
#include "core/exemplar/features.h"
#include "core/exemplar/repeats.h"
#include "core/exemplar/uv_map.h"
#include "core/material/material.h"
#include "tests/runner/fakes.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

ImagePtr floats(Size size, int channels) {
  return make_image(size, channels, [](int, int, int) { return 0.5f; });
}

/// A recipe that reads from nothing, by a name of its own.
ImagePtr recipe(uint64_t number) {
  return Image::computed({.size = {8, 8}}, Digest{number, 1}, [](const Rect&, float*) {});
}

/// Values are told apart by their addresses, so they live until the end, as they do in a run while they are held.
struct Held {
  explicit Held(size_t stages) : memory(stages) {}
  void hold_computed(int stage, std::map<std::string, Value> values, const std::vector<int>& inputs) {
    memory.hold_computed(stage, alive.emplace_back(std::move(values)), inputs);
  }
  void hold_loaded(int stage, std::map<std::string, Value> values) {
    memory.hold_loaded(stage, alive.emplace_back(std::move(values)));
  }
  void release(int stage) { memory.release(stage); }
  uint64_t bytes() const { return memory.bytes(); }
  uint64_t bytes_freed_by(int stage) const { return memory.bytes_freed_by(stage); }

  HeldMemory memory;
  std::vector<std::map<std::string, Value>> alive;
};

}  // namespace

TEST_CASE("values take what their pixels, vectors and positions take") {
  Held held(8);
  held.hold_computed(0, {{"out", floats({10, 4}, 3)}}, {});
  CHECK(held.bytes() == 480);
  std::vector<uint16_t> halfs(20);
  held.hold_computed(1, {{"out", Image::from_halfs({.size = {5, 4}, .depth = Depth::f16}, halfs)}}, {});
  CHECK(held.bytes() == 480 + 40);
  held.hold_computed(2, {{"out", UvMap::make({6, 5}, {9, 9}, std::vector<ExemplarPixel>(30))}}, {});
  CHECK(held.bytes() == 480 + 40 + 120);
  held.hold_computed(3, {{"out", recipe(1)}}, {});
  CHECK(held.bytes() == 480 + 40 + 120);
  held.hold_computed(6, {{"out", Image::from_integers({.size = {5, 3}, .channels = 2}, std::vector<uint8_t>(30))}}, {});
  CHECK(held.bytes() == 480 + 40 + 120 + 30);
  held.release(6);
  AppearanceLevel level{.size = {4, 4}, .vectors = std::vector<AppearanceVector>(16), .mean = {}, .basis = {}};
  level.usable.assign(16, 1);
  const AppearancePtr looks = Appearance::make({level}, 3, false);
  held.hold_computed(4, {{"out", looks}}, {});
  CHECK(held.bytes() == 640 + 16 * 16 + 16);
  held.hold_computed(5, {{"out", Index::make(looks, {{.per_pixel = 2, .positions = std::vector<uint32_t>(32)}})}}, {});
  CHECK(held.bytes() == 640 + 272 + 128);
  held.release(4);  // the index has it still
  CHECK(held.bytes() == 640 + 272 + 128);
  for (int i = 0; i < 8; i++) held.release(i);
  CHECK(held.bytes() == 0);
}

TEST_CASE("images from the cache are read from there, and take no memory") {
  Held held(2);
  held.hold_computed(0, {{"out", floats({10, 10}, 1)}}, {});
  held.hold_loaded(1, {{"out", recipe(1)}});
  CHECK(held.bytes() == 400);
  held.hold_loaded(1, {{"out", UvMap::make({6, 5}, {9, 9}, std::vector<ExemplarPixel>(30))}});
  CHECK(held.bytes() == 520);
}

TEST_CASE("what several values share counts once, and until the last of them goes") {
  Held held(3);
  const ImagePtr image = floats({10, 10}, 1);
  held.hold_computed(0, {{"out", image}}, {});
  held.hold_computed(
      1, {{"a", Material::of(image)}, {"b", Image::redescribed(image, {.size = {10, 10}, .depth = Depth::u8})}}, {});
  CHECK(held.bytes() == 400);
  held.release(0);
  held.release(0);
  CHECK(held.bytes() == 400);
  held.hold_computed(1, {{"a", floats({5, 5}, 1)}}, {});
  CHECK(held.bytes() == 100);
}

TEST_CASE("a lazy image keeps what it reads from, along any number of stages") {
  constexpr int stages = 20000;
  Held held(stages + 2);
  held.hold_computed(0, {{"out", floats({10, 10}, 1)}}, {});
  held.hold_computed(1, {{"out", floats({10, 1}, 1)}}, {});
  for (int i = 2; i < stages; i++) {
    held.hold_computed(i, {{"out", recipe(uint64_t(i))}}, {i - 1, i == 2 ? 0 : i - 2});
    if (i > 4) held.release(i - 3);
  }
  held.release(0);
  held.release(1);
  CHECK(held.bytes() == 440);
  held.hold_computed(stages, {{"out", floats({2, 2}, 1)}}, {stages - 1});  // computed: it has its own pixels
  for (int i = 2; i < stages; i++) held.release(i);
  CHECK(held.bytes() == 16);
}

TEST_CASE("a stage that is made again does not disturb what is read from its earlier values") {
  Held held(2);
  held.hold_computed(0, {{"out", floats({10, 10}, 1)}}, {});
  held.hold_computed(1, {{"out", recipe(1)}}, {0});
  held.release(0);
  held.hold_computed(0, {{"out", floats({5, 10}, 1)}}, {});
  CHECK(held.bytes() == 600);
  held.release(1);
  CHECK(held.bytes() == 200);
}

TEST_CASE("a release frees what no other stage holds") {
  Held held(3);
  const ImagePtr shared = floats({10, 10}, 1), own = floats({5, 5}, 1);
  held.hold_computed(0, {{"a", own}, {"b", own}, {"c", shared}}, {});
  CHECK(held.bytes_freed_by(0) == 500);
  CHECK(held.bytes_freed_by(1) == 0);
  held.hold_computed(1, {{"out", shared}}, {0});
  CHECK(held.bytes_freed_by(0) == 100);
  CHECK(held.bytes_freed_by(1) == 0);
  held.hold_computed(2, {{"out", recipe(1)}}, {0});  // reads from the first one
  CHECK(held.bytes_freed_by(0) == 0);
  held.release(2);
  const uint64_t before = held.bytes(), freed = held.bytes_freed_by(0);
  held.release(0);
  CHECK(held.bytes() == before - freed);
}
