#include "core/procedural/labels.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <doctest/doctest.h>

#include "core/base/disjoint_sets.h"
#include "core/procedural/pattern.h"

using namespace terrazzo;

namespace {

/// The numbers that were divided by (count - 1).
struct Labels {
  Size size;
  std::vector<int> numbers;
  int count = 0;

  int at(int x, int y) const { return numbers[size_t(y) * size.width + x]; }
};

Labels labels_of(const PatternSpec& spec) {
  const ImagePtr image = pattern_labels(spec, Task());
  const std::vector<float> pixels = image->pixels();
  const std::set<float> values(pixels.begin(), pixels.end());
  Labels out{image->size(), {}, int(values.size())};
  for (const float v : pixels) out.numbers.push_back(int(std::lround(double(v) * std::max(1, out.count - 1))));
  return out;
}

/// How many regions of one label there are, by sides that pixels share, around the borders too if `wraps`.
int regions(const Labels& labels, bool wraps) {
  const auto [w, h] = labels.size;
  DisjointSets sets(uint32_t(w * h));
  const auto join = [&](int x, int y, int nx, int ny) {
    if (!wraps && (nx == w || ny == h)) return;
    nx %= w;
    ny %= h;
    if (labels.at(x, y) == labels.at(nx, ny)) sets.join(uint32_t(y * w + x), uint32_t(ny * w + nx));
  };
  for (int y = 0; y < h; y++)
    for (int x = 0; x < w; x++) {
      join(x, y, x + 1, y);
      join(x, y, x, y + 1);
    }
  std::set<uint32_t> roots;
  for (uint32_t i = 0; i < uint32_t(w * h); i++) roots.insert(sets.find(i));
  return int(roots.size());
}

/// Elements on a square canvas, by the square of the scale; the other types have none.
const std::map<std::string, double> elements_per_scale = {
    {"bricks", 2.75}, {"cobbles", 1.12},        {"tiles", 1},     {"planks", 0.25},    {"herringbone", 2},
    {"rubble", 1},    {"coursed_rubble", 1.79}, {"ashlar", 1.55}, {"crazy_paving", 1}, {"slates", 1.7},
    {"chevron", 2.6}, {"plates", 1.59},         {"panels", 1.62}, {"flagstones", 1.1}};

}  // namespace

TEST_CASE("labels are numbers in order of first appearance, divided by the last, in one guidance channel") {
  const ImagePtr image = pattern_labels({.type = "tiles", .size = {30, 30}, .scale = 3}, Task());
  CHECK(image->channels() == 1);
  CHECK(image->info().semantic == Semantic::guidance);
  CHECK(image->info().depth == Depth::u16);
  const std::vector<float> pixels = image->pixels();
  for (int y = 0; y < 30; y++)
    for (int x = 0; x < 30; x++) REQUIRE(pixels[size_t(y) * 30 + x] == float((y / 10 * 3 + x / 10) / 8.0));
}

TEST_CASE("there are about as many elements as the scale says, and none in weave, gravel and sheet metal") {
  for (const PatternType& type : pattern_types())
    for (const double scale : {8.0, 12.0})
      for (const bool tileable : {true, false}) {
        CAPTURE(type.name);
        CAPTURE(scale);
        CAPTURE(tileable);
        const Labels labels = labels_of({.type = type.name, .size = {240, 240}, .scale = scale, .tileable = tileable});
        const auto expected = elements_per_scale.find(type.name);
        if (expected == elements_per_scale.end()) {
          CHECK(labels.count == 1);
          CHECK(labels.at(80, 80) == 0);
          continue;
        }
        // The border cuts through elements where it does not tile, which adds to those whose middles are inside.
        const double inside = expected->second * scale * scale;
        CHECK(labels.count > 0.75 * inside);
        CHECK(labels.count < 1.3 * inside + (tileable ? 0 : 4 * std::sqrt(inside)));
      }
}

TEST_CASE("every element is one region, around the border where the pattern tiles") {
  for (const PatternType& type : pattern_types())
    for (const double irregularity : {0.0, 0.5, 1.0})
      for (const bool tileable : {true, false}) {
        CAPTURE(type.name);
        CAPTURE(irregularity);
        CAPTURE(tileable);
        const Labels labels = labels_of({.type = type.name,
                                         .size = {320, 280},
                                         .seed = 3,
                                         .scale = 4,
                                         .irregularity = irregularity,
                                         .tileable = tileable});
        CHECK(regions(labels, tileable) == labels.count);
      }
}

TEST_CASE("elements go on over the border of a wrapping canvas") {
  const Canvas canvas({90, 72}, true, 3);
  for (const PatternType& type : pattern_types()) {
    CAPTURE(type.name);
    const auto surface = type.make(canvas, {.size = {90, 72}, .scale = 2.6}, type.palettes.front());
    for (double t = 0.0131; t < 0.8; t += 0.0617) {
      CHECK(surface->element(-0.013, t) == surface->element(0.987, t));
      CHECK(surface->element(1.021, t) == surface->element(0.021, t));
      CHECK(surface->element(t, -0.013) == surface->element(t, 0.787));
      CHECK(surface->element(t, 0.821) == surface->element(t, 0.021));
    }
  }
}

TEST_CASE("labels change in the joints: the surface is low where they do") {
  for (const PatternType& type : pattern_types()) {
    if (!elements_per_scale.contains(type.name)) continue;
    CAPTURE(type.name);
    const PatternSpec spec{.type = type.name, .size = {200, 200}, .scale = 3, .irregularity = 0.3, .wear = 0};
    const Labels labels = labels_of(spec);
    const std::vector<float> heights = make_pattern(spec, Task())->find("height")->pixels();
    double between = 0, all = 0;
    int borders = 0;
    for (int y = 0; y < 200; y++)
      for (int x = 0; x < 200; x++) {
        const double here = heights[size_t(y) * 200 + x];
        all += here / 40000;
        if (labels.at(x, y) == labels.at(x, (y + 1) % 200)) continue;
        borders++;
        between += here;
      }
    CHECK(between / borders < all - 0.1);
  }
}

TEST_CASE("the same labels come out twice, others with another seed where places are random") {
  for (const PatternType& type : pattern_types()) {
    CAPTURE(type.name);
    PatternSpec spec{.type = type.name, .size = {192, 160}, .seed = 5, .irregularity = 1};
    const Digest first = pattern_labels(spec, Task())->digest();
    CHECK(pattern_labels(spec, Task())->digest() == first);
    spec.seed = 6;
    const bool random = elements_per_scale.contains(type.name) && type.name != "tiles" && type.name != "chevron" &&
                        type.name != "panels";
    CHECK((pattern_labels(spec, Task())->digest() != first) == random);
  }
}

TEST_CASE("labels and maps of tiny canvases and of extreme scales can be made") {
  for (const PatternType& type : pattern_types())
    for (const Size size : {Size{1, 1}, Size{16, 16}, Size{3, 40}, Size{40, 3}})
      for (const double scale : {1.0, 64.0})
        for (const bool tileable : {true, false}) {
          CAPTURE(type.name);
          CAPTURE(scale);
          const PatternSpec spec{
              .type = type.name, .size = size, .scale = scale, .irregularity = 1, .wear = 1, .tileable = tileable};
          CHECK(make_pattern(spec, Task())->size() == size);
          const Labels labels = labels_of(spec);
          CHECK(labels.size == size);
          CHECK(labels.count <= size.area());
          CHECK(regions(labels, tileable) == labels.count);
        }
}
