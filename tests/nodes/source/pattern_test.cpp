#include "core/procedural/pattern.h"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include "nodes/common/registry.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

MaterialPtr pattern(const Params& params) {
  return run_node("pattern", params).get<Material>("material");
}

/// How closely two lists go together, -1..1.
double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ma = 0, mb = 0, ab = 0, aa = 0, bb = 0;
  for (size_t i = 0; i < a.size(); i++) {
    ma += a[i] / double(a.size());
    mb += b[i] / double(b.size());
  }
  for (size_t i = 0; i < a.size(); i++) {
    ab += (a[i] - ma) * (b[i] - mb);
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

/// The mean difference between neighbouring columns (x, x + 1), the last with the first for x = width - 1.
std::vector<double> column_steps(const Image& image) {
  const std::vector<float> p = image.pixels();
  const int w = image.width(), h = image.height(), c = image.channels();
  std::vector<double> steps(size_t(w), 0.0);
  for (int y = 0; y < h; y++)
    for (int x = 0; x < w; x++)
      for (int k = 0; k < c; k++)
        steps[size_t(x)] += std::abs(p[(size_t(y) * w + x) * c + k] - p[(size_t(y) * w + (x + 1) % w) * c + k]);
  return steps;
}

std::vector<double> row_steps(const Image& image) {
  const std::vector<float> p = image.pixels();
  const int w = image.width(), h = image.height(), c = image.channels();
  std::vector<double> steps(size_t(h), 0.0);
  for (int y = 0; y < h; y++)
    for (int i = 0; i < w * c; i++)
      steps[size_t(y)] += std::abs(p[size_t(y) * w * c + i] - p[size_t((y + 1) % h) * w * c + i]);
  return steps;
}

}  // namespace

TEST_CASE("every pattern makes five maps of one size in sensible ranges") {
  for (const PatternType& type : pattern_types()) {
    CAPTURE(type.name);
    const MaterialPtr m = pattern({{"kind", type.name}, {"size", Size{72, 56}}, {"scale", 3.0}});
    CHECK(m->map_names() == "base_color, normal, height, roughness, ambient_occlusion");
    for (const Map& map : m->maps()) {
      CAPTURE(map.name);
      CHECK(map.image->size() == Size{72, 56});
      const int steps = map.image->info().depth == Depth::u16 ? 65535 : 255;
      bool in_steps = true;
      double low = 1, high = 0;
      for (const float v : map.image->pixels()) {
        in_steps = in_steps && v == float(std::lround(double(v) * steps)) / float(steps);
        low = std::min(low, double(v));
        high = std::max(high, double(v));
      }
      CHECK(in_steps);
      CHECK(low >= 0);
      CHECK(high <= 1);
      CHECK(high - low > 0.05);
    }
    CHECK(m->find(Semantic::base_color)->info().color_space == "srgb_texture");
    CHECK(m->find(Semantic::normal)->info().normal_y == NormalY::up);
    CHECK(m->find(Semantic::height)->info().depth == Depth::u16);
  }
}

TEST_CASE("normals follow the height, and recesses are occluded") {
  for (const PatternType& type : pattern_types()) {
    CAPTURE(type.name);
    const MaterialPtr m = pattern({{"kind", type.name}, {"size", Size{96, 96}}, {"scale", 3.0}, {"tileable", false}});
    const std::vector<float> h = m->find("height")->pixels(), n = m->find("normal")->pixels(),
                             ao = m->find("ambient_occlusion")->pixels();
    std::vector<double> nx, ny, dx, dy, occluded, around;
    for (int y = 4; y < 92; y++)
      for (int x = 4; x < 92; x++) {
        const size_t i = size_t(y) * 96 + x;
        nx.push_back((n[i * 3] - 0.5) / (n[i * 3 + 2] - 0.5));
        ny.push_back((n[i * 3 + 1] - 0.5) / (n[i * 3 + 2] - 0.5));
        dx.push_back(h[i - 1] - h[i + 1]);
        dy.push_back(h[i + 96] - h[i - 96]);
        double mean = 0;
        for (int b = -4; b <= 4; b++)
          for (int a = -4; a <= 4; a++) mean += h[size_t(y + b) * 96 + x + a] / 81;
        occluded.push_back(1 - ao[i]);
        around.push_back(mean - h[i]);
      }
    CHECK(correlation(nx, dx) > 0.95);
    CHECK(correlation(ny, dy) > 0.95);
    CHECK(correlation(occluded, around) > 0.4);
  }
}

TEST_CASE("a tileable pattern has no seam, even where pieces do not fit the size") {
  for (const PatternType& type : pattern_types()) {
    const MaterialPtr m = pattern({{"kind", type.name}, {"size", Size{90, 72}}, {"scale", 2.6}, {"tileable", true}});
    for (const Map& map : m->maps()) {
      CAPTURE(type.name);
      CAPTURE(map.name);
      for (const std::vector<double>& steps : {column_steps(*map.image), row_steps(*map.image)}) {
        std::vector<double> inside(steps.begin(), steps.end() - 1);
        CHECK(steps.back() < 1.3 * *std::max_element(inside.begin(), inside.end()));
      }
    }
  }
}

TEST_CASE("a tileable surface goes on over the border as it begins at the other") {
  const Size size{90, 72};
  const Canvas canvas(size, true, 3);
  for (const PatternType& type : pattern_types()) {
    CAPTURE(type.name);
    const auto surface = type.make(canvas, {.scale = 2.6}, type.palettes.front());
    const auto check = [](const SurfacePoint& a, const SurfacePoint& b) {
      CHECK(a.height == doctest::Approx(b.height).epsilon(1e-6));
      CHECK(a.color.g == doctest::Approx(b.color.g).epsilon(1e-6));
      CHECK(a.roughness == doctest::Approx(b.roughness).epsilon(1e-6));
    };
    for (double t = 0.0131; t < 0.8; t += 0.0617) {
      check(surface->at(-0.013, t), surface->at(0.987, t));
      check(surface->at(1.021, t), surface->at(0.021, t));
      check(surface->at(t, -0.013), surface->at(t, 0.787));
      check(surface->at(t, 0.821), surface->at(t, 0.021));
    }
  }
}

TEST_CASE("the same parameters give the same pattern, other seeds and palettes another") {
  for (const PatternType& type : pattern_types()) {
    CAPTURE(type.name);
    Params params = {{"kind", type.name}, {"size", Size{32, 32}}};
    const Digest first = pattern(params)->digest();
    CHECK(pattern(params)->digest() == first);
    params["seed"] = int64_t{7};
    const MaterialPtr other = pattern(params);
    CHECK(other->digest() != first);
    params["palette"] = type.palettes.back().name;
    const MaterialPtr recolored = pattern(params);
    CHECK(recolored->find("height")->digest() == other->find("height")->digest());
    CHECK(recolored->find("base_color")->digest() != other->find("base_color")->digest());
  }
}

TEST_CASE("one thread and several make the same pattern") {
  const Params params = {{"kind", "gravel"}, {"size", Size{64, 48}}};
  const Digest several = pattern(params)->digest();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  CHECK(pattern(params)->digest() == several);
}

TEST_CASE("relief deepens slopes and occlusion and leaves the height map as it is") {
  const auto made = [](double relief) { return pattern({{"size", Size{48, 48}}, {"relief", relief}}); };
  const auto mean = [](const ImagePtr& image, int channel) {
    const std::vector<float> p = image->pixels();
    double sum = 0;
    for (size_t i = size_t(channel); i < p.size(); i += size_t(image->channels())) sum += p[i];
    return sum / double(image->size().area());
  };
  const MaterialPtr flat = made(0), natural = made(1), deep = made(3);
  CHECK(flat->find("height")->digest() == deep->find("height")->digest());
  CHECK(mean(flat->find("normal"), 2) == doctest::Approx(1));
  CHECK(mean(natural->find("normal"), 2) > mean(deep->find("normal"), 2));
  CHECK(mean(natural->find("ambient_occlusion"), 0) > mean(deep->find("ambient_occlusion"), 0));
}

TEST_CASE("labels come along as a map if they are asked for, of its size, and do not depend on its colours or depth") {
  for (const PatternType& type : pattern_types()) {
    CAPTURE(type.name);
    Params params = {{"kind", type.name}, {"size", Size{56, 40}}, {"scale", 3.0}, {"labels", true}};
    const auto labels = [&] { return run_node("pattern", params).get<Material>("material")->find("labels"); };
    const ImagePtr first = labels();
    CHECK(first->size() == Size{56, 40});
    CHECK(first->info().semantic == Semantic::guidance);
    const std::vector<float> pixels = first->pixels();
    const bool pieces = type.name != "weave" && type.name != "gravel" && type.name != "sheet_metal";
    CHECK(pixels.front() == 0);
    CHECK(*std::max_element(pixels.begin(), pixels.end()) == (pieces ? 1 : 0));
    params["palette"] = type.palettes.back().name;
    params["relief"] = 3.0;
    params["wear"] = 0.0;
    CHECK(labels()->digest() == first->digest());
  }
}

TEST_CASE("patterns of odd sizes can be made") {
  for (const PatternType& type : pattern_types())
    for (const Size size : {Size{16, 16}, Size{1, 1}, Size{64, 17}, Size{17, 64}})
      for (const bool tileable : {true, false})
        CHECK(pattern({{"kind", type.name}, {"size", size}, {"tileable", tileable}})->size() == size);
}

TEST_CASE("a palette the kind does not have is refused with those it has") {
  const NodeType* type = find_node_type("pattern");
  Params params;
  for (const Param& p : type->params) params[p.name] = *p.fallback;
  CHECK(type->check(params).empty());
  params["palette"] = "mauve";
  CHECK(type->check(params) ==
        std::vector<std::string>{"\"palette\": bricks come in red, stock, charcoal, not in \"mauve\""});
  CHECK_THROWS_WITH_AS(make_pattern({.type = "lace"}, Task()),
                       doctest::Contains("there is no pattern \"lace\"; there are bricks, cobbles"), Error);
}
