#include "core/material/variants.h"

#include <array>
#include <cmath>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/image/normal.h"
#include "nodes/common/registry.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

Exemplar of(const ImagePtr& image) {
  return {Material::of(image), nullptr};
}

ImagePtr varied_map(const ImagePtr& image, const Variant& variant, Outside outside = Outside::clamp) {
  return varied(of(image), variant, outside).material->maps().front().image;
}

ImagePtr tilted(Vector3f normal, NormalY normal_y, Size size = {12, 10}) {
  ImageInfo info{.size = size, .channels = 3, .semantic = Semantic::normal, .normal_y = normal_y};
  std::vector<float> pixels(size_t(size.area()) * 3);
  for (size_t i = 0; i < pixels.size(); i += 3) encode_normal(normal, normal_y, &pixels[i]);
  return Image::from_floats(info, pixels);
}

Vector3f middle_normal(const ImagePtr& map) {
  return decode_normal(map->read({map->width() / 2, map->height() / 2, 1, 1}).data(), map->info().normal_y);
}

void check_vector(const Vector3f& v, const Vector3f& expected) {
  for (size_t i = 0; i < 3; i++) CHECK(double(v[i]) == doctest::Approx(double(expected[i])).epsilon(1e-4));
}

Params params_of(const Numbers& rotations, const Numbers& scales, const std::string& mirror) {
  return {{"rotations", rotations}, {"scales", scales}, {"mirror", mirror}};
}

}  // namespace

TEST_CASE("quarter turns and mirroring move pixels and change none") {
  const Size size{5, 3};
  const ImagePtr image = make_image(size, 2, [](int x, int y, int c) { return float(x + 10 * y + 100 * c); });
  const auto at = [](const ImagePtr& i, int x, int y) { return i->read({x, y, 1, 1}).front(); };
  const ImagePtr quarter = varied_map(image, {.rotation = 90});
  REQUIRE(quarter->size() == Size{3, 5});
  CHECK(at(quarter, 0, 0) == 4);  // counter-clockwise: what was at the top right is at the top left
  CHECK(at(quarter, 0, 4) == 0);
  CHECK(at(quarter, 2, 4) == 20);
  CHECK(at(varied_map(image, {.rotation = 180}), 0, 0) == 24);
  CHECK(at(varied_map(image, {.rotation = -90}), 0, 0) == 20);
  CHECK(at(varied_map(image, {.mirror_x = true}), 0, 0) == 4);
  CHECK(at(varied_map(image, {.mirror_y = true}), 0, 0) == 20);
  CHECK(at(varied_map(image, {.mirror_x = true, .rotation = 90}), 0, 0) == 0);
  const ImagePtr around = varied_map(varied_map(image, {.rotation = 270}), {.rotation = 450});
  CHECK(around->pixels() == image->pixels());
}

TEST_CASE("normals turn with the surface in both conventions") {
  for (const NormalY normal_y : {NormalY::up, NormalY::down}) {
    const ImagePtr facing_right = tilted({0.6f, 0, 0.8f}, normal_y);
    check_vector(middle_normal(varied_map(facing_right, {.rotation = 90})), {0, 0.6f, 0.8f});
    check_vector(middle_normal(varied_map(facing_right, {.rotation = 180})), {-0.6f, 0, 0.8f});
    check_vector(middle_normal(varied_map(facing_right, {.rotation = 30})), {0.6f * 0.8660254f, 0.3f, 0.8f});
    check_vector(middle_normal(varied_map(facing_right, {.rotation = 120})), {-0.3f, 0.6f * 0.8660254f, 0.8f});
    check_vector(middle_normal(varied_map(facing_right, {.mirror_x = true})), {-0.6f, 0, 0.8f});
    check_vector(middle_normal(varied_map(facing_right, {.mirror_y = true})), {0.6f, 0, 0.8f});
    check_vector(middle_normal(varied_map(facing_right, {.mirror_x = true, .rotation = 90})), {0, -0.6f, 0.8f});
    check_vector(middle_normal(varied_map(facing_right, {.scale = 0.5})), {0.6f, 0, 0.8f});
  }
}

TEST_CASE("turned heights and turned normals still fit together") {
  const auto bump = [](int x, int y, int) {
    const double dx = (x - 17) / 9.0, dy = (y - 12) / 6.0;
    return float(std::exp(-dx * dx - dy * dy));
  };
  const ImagePtr height = make_image({32, 28}, 1, bump, Semantic::height);
  const Params slopes{{"height_scale", 8.0}};
  const Exemplar exemplar{
      Material::make("m", {{"height", height}, {"normal", run_image("make_normal", slopes, {{"height", height}})}}),
      nullptr};
  for (const Variant& v : {Variant{1, false, false, 90}, Variant{1, true, false, 25}, Variant{1, false, true, -100}}) {
    const Exemplar turned = varied(exemplar, v, Outside::clamp);
    const ImagePtr from_height = run_image("make_normal", slopes, {{"height", turned.material->find("height")}});
    const ImagePtr normal = turned.material->find("normal");
    REQUIRE(normal->size() == from_height->size());
    const Rect inner{normal->width() / 2 - 7, normal->height() / 2 - 7, 14, 14};
    const std::vector<float> a = normal->read(inner), b = from_height->read(inner);
    for (size_t i = 0; i < a.size(); i++) REQUIRE(std::fabs(a[i] - b[i]) < 0.02f);
  }
}

TEST_CASE("a rotated copy shows its source where it should, and its corners are masked out") {
  const ImagePtr ramp = make_image(
      {40, 30}, 1, [](int x, int, int) { return float(x); }, Semantic::roughness);
  const Exemplar turned = varied(of(ramp), {.rotation = 30}, Outside::clamp);
  const ImagePtr map = turned.material->maps().front().image;
  REQUIRE(turned.mask);
  CHECK(turned.mask->size() == map->size());
  CHECK(map->size() == Size{50, 46});
  CHECK(turned.mask->read({0, 0, 1, 1}).front() == 0);
  CHECK(turned.mask->read({25, 23, 1, 1}).front() == 1);
  const std::vector<float> p = map->pixels(), mask = turned.mask->pixels();
  double marked = 0;
  for (int y = 0; y < 46; y++)
    for (int x = 0; x < 50; x++) {
      if (mask[size_t(y * 50 + x)] < 0.5f) continue;
      marked++;
      const double source = 19.5 + (x - 24.5) * std::sqrt(0.75) - (y - 22.5) * 0.5;
      if (source > 1 && source < 38) REQUIRE(double(p[size_t(y * 50 + x)]) == doctest::Approx(source).epsilon(1e-4));
    }
  CHECK(marked == doctest::Approx(39 * 29).epsilon(0.03));
}

TEST_CASE("an exemplar that tiles fills the corners of its copies") {
  const ImagePtr stripes = make_image({16, 16}, 1, [](int x, int, int) { return x % 8 < 4 ? 0.f : 1.f; });
  const Exemplar turned = varied(of(stripes), {.rotation = 45}, Outside::wrap);
  CHECK_FALSE(turned.mask);
  const std::vector<float> p = turned.material->maps().front().image->pixels();
  double mean = 0;
  for (const float v : p) mean += double(v) / double(p.size());
  CHECK(mean == doctest::Approx(0.5).epsilon(0.05));
}

TEST_CASE("masks are sampled, not blurred, whatever is done to them") {
  const ImagePtr mask = make_image(
      {20, 20}, 1, [](int x, int y, int) { return (x / 5 + y / 5) % 2 ? 1.f : 0.f; }, Semantic::mask);
  for (const Variant& v :
       {Variant{0.7, false, false, 0}, Variant{1, true, false, 33}, Variant{1.6, false, true, 290}}) {
    const Exemplar e = varied({Material::of(mask), mask}, v, Outside::clamp);
    for (const float p : e.mask->pixels()) REQUIRE((p == 0 || p == 1));
    for (const float p : e.material->maps().front().image->pixels()) REQUIRE((p == 0 || p == 1));
  }
}

TEST_CASE("scaling is that of the whole body: heights part from their mean, normals stay") {
  const auto waves = [](int x, int, int) { return float(0.5 + 0.2 * std::sin(x * 0.2)); };
  const ImagePtr height = make_image({63, 20}, 1, waves, Semantic::height);
  const auto span = [](const ImagePtr& image) {
    const std::vector<float> p = image->pixels();
    const auto [low, high] = std::minmax_element(p.begin(), p.end());
    return double(*high - *low);
  };
  CHECK(span(varied_map(height, {.scale = 0.5})) == doctest::Approx(0.5 * span(height)).epsilon(0.03));
  const ImagePtr larger = varied_map(height, {.scale = 2});
  CHECK(larger->size() == Size{126, 40});
  CHECK(span(larger) == doctest::Approx(2 * span(height)).epsilon(0.03));
  CHECK(span(varied_map(with_depth(height, Depth::u8), {.scale = 4})) <= 1);
}

TEST_CASE("maps of a material keep their proportions through every variant") {
  const Exemplar e{Material::make("m", {{"base_color", noise_image({24, 36}, 3, Semantic::base_color, "srgb_texture")},
                                        {"roughness", noise_image({8, 12}, 1, Semantic::roughness)}}),
                   nullptr};
  for (const Variant& v :
       {Variant{0.77, false, false, 0}, Variant{1, false, false, 90}, Variant{1.3, true, true, 20}}) {
    const MaterialPtr m = varied(e, v, Outside::clamp).material;
    const Size large = m->find("base_color")->size(), small = m->find("roughness")->size();
    CHECK(large == Size{3 * small.width, 3 * small.height});
    for (const Map& map : m->maps()) check_tiles_agree(*map.image);
  }
}

TEST_CASE("variants holds the original first and every copy once") {
  const ImagePtr image = noise_image({12, 12}, 3, Semantic::base_color, "srgb_texture");
  const auto labels = [&](const Params& params) {
    std::vector<float> p = run_node("variants", params, {{"material", {image}}}).get<Image>("labels")->pixels();
    std::sort(p.begin(), p.end());
    return std::unique(p.begin(), p.end()) - p.begin();
  };
  CHECK(labels(params_of({90, 180, 270}, {}, "none")) == 4);
  CHECK(labels(params_of({0, 360, -270, 90}, {1, 0.5}, "none")) == 4);
  CHECK(labels(params_of({}, {}, "x")) == 2);
  CHECK(labels(params_of({}, {}, "xy")) == 4);
  CHECK(labels(params_of({90}, {0.5}, "y")) == 8);
  const NodeRun run = run_node("variants", params_of({180}, {}, "none"), {{"material", {image}}});
  const ImagePtr atlas = run.get<Material>("material")->find("base_color");
  CHECK(atlas->read({0, 0, 12, 12}) == image->pixels());
  check_tiles_agree(*atlas);
}

TEST_CASE("variants tells its size, and how to make it smaller if analysis of it would take long") {
  const auto note_of = [](Size size) {
    const NodeRun run = run_node("variants", params_of({90, 180, 270}, {}, "none"),
                                 {{"material", {flat_image(size, {0.5f}, Semantic::roughness)}}});
    REQUIRE(run.notes.size() == 1);
    return run.notes.front();
  };
  CHECK(note_of({1020, 1020}) == "4 exemplars in 2048x2048 pixels");
  CHECK(note_of({1021, 1021}) ==
        "4 exemplars in 2050x2050 pixels; analysing so many takes long and needs much memory: use fewer `rotations` or "
        "`scales`, or put \"resize\" before this");
}

TEST_CASE("variants masks out what the exemplar's own mask leaves out") {
  const ImagePtr image = noise_image({10, 10}, 1, Semantic::roughness);
  const ImagePtr top = make_image({10, 10}, 1, [](int, int y, int) { return y < 4 ? 1.f : 0.f; });
  const auto mask = run_node("variants", params_of({90, 180}, {}, "none"), {{"material", {image}}, {"mask", {top}}})
                        .get<Image>("mask");
  double marked = 0;
  for (const float v : mask->pixels()) marked += double(v);
  CHECK(marked == 3 * 40);
}

TEST_CASE("too many copies are refused when the graph is checked") {
  Numbers many;
  for (int i = 1; i <= 16; i++) many.push_back(i);
  const NodeType* type = find_node_type("variants");
  CHECK(type->check(params_of(many, {}, "x")).empty());
  CHECK(type->check(params_of(many, {0.5}, "x")).front().find("68 copies; expected at most 64") != std::string::npos);
}
