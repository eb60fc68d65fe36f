#include "core/material/atlas.h"

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/image/normal.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

MaterialPtr material_of(const std::string& name, const std::vector<Map>& maps) {
  return Material::make(name, maps);
}

/// A material of a colour and a height map, the height `divisor` times smaller.
MaterialPtr two_maps(Size size, int divisor, unsigned seed) {
  return material_of(
      std::string(1, char('a' + int(seed))),
      {{"base_color", noise_image(size, 3, Semantic::base_color, "srgb_texture", seed)},
       {"height", noise_image({size.width / divisor, size.height / divisor}, 1, Semantic::height, "raw", seed + 9)}});
}

/// Whether the map of the atlas shows `source` at `place`, pixel by pixel.
bool shows(const Image& atlas, const Rect& place, const Image& source) {
  return atlas.read(place) == source.pixels();
}

void check_apart(const std::vector<Rect>& places, int gap, Size size) {
  for (size_t i = 0; i < places.size(); i++) {
    CHECK(intersect(places[i], whole(size)) == places[i]);
    for (size_t j = 0; j < i; j++) CHECK(intersect(grown(places[i], gap), places[j]).empty());
  }
}

}  // namespace

TEST_CASE("every exemplar lies in the atlas pixel by pixel, apart from the others") {
  std::vector<Exemplar> exemplars;
  for (const Size size : {Size{20, 30}, Size{31, 9}, Size{12, 12}, Size{5, 40}, Size{1, 1}})
    exemplars.push_back({two_maps(size, 1, unsigned(exemplars.size())), nullptr});
  const Atlas atlas = make_atlas(exemplars, 3, Outside::clamp);
  const Size size = atlas.material->size();
  REQUIRE(atlas.places.size() == exemplars.size());
  check_apart(atlas.places, 3, size);
  for (size_t i = 0; i < exemplars.size(); i++)
    for (const Map& m : exemplars[i].material->maps())
      CHECK(shows(*atlas.material->find(m.name), atlas.places[i], *m.image));
  CHECK(double(size.area()) < 3 * 1400.0);
}

TEST_CASE("the mask is 1 where exemplars are, and the labels count them") {
  const Exemplar whole_one{two_maps({10, 12}, 1, 1), nullptr};
  const ImagePtr left_half = make_image(
      {10, 10}, 1, [](int x, int, int) { return x < 5 ? 1.f : 0.f; }, Semantic::mask);
  const Exemplar half{two_maps({20, 10}, 1, 2), left_half};
  const Atlas atlas = make_atlas({whole_one, half, whole_one}, 4, Outside::clamp);
  const Size size = atlas.material->size();
  CHECK(atlas.mask->size() == size);
  CHECK(atlas.labels->size() == size);
  CHECK(atlas.mask->info().semantic == Semantic::mask);
  double marked = 0;
  for (const float v : atlas.mask->pixels()) marked += double(v);
  CHECK(marked == 120 + 100 + 120);
  for (size_t i = 0; i < 3; i++) {
    for (const float label : atlas.labels->read(atlas.places[i])) REQUIRE(label == 0.5f * float(i));
    const std::vector<float> mask = atlas.mask->read(atlas.places[i]);
    for (int x = 0; x < atlas.places[i].width; x++) REQUIRE(mask[size_t(x)] == (i == 1 && x >= 10 ? 0.f : 1.f));
  }
}

TEST_CASE("gaps show what lies beyond the exemplar's border") {
  const ImagePtr ramp = make_image(
      {8, 8}, 1, [](int x, int y, int) { return float(x + 10 * y); }, Semantic::height);
  const Exemplar e{Material::of(ramp), nullptr};
  for (const Outside outside : {Outside::clamp, Outside::wrap}) {
    const Atlas atlas = make_atlas({e, e}, 6, outside);
    REQUIRE(atlas.material->size() == Size{22, 8});
    const float beyond = atlas.material->maps().front().image->read({8, 2, 1, 1}).front();
    CHECK(beyond == (outside == Outside::clamp ? 27 : 20));
    const float before = atlas.material->maps().front().image->read({13, 2, 1, 1}).front();
    CHECK(before == (outside == Outside::clamp ? 20 : 27));
  }
}

TEST_CASE("smaller maps stay smaller and aligned where all are, and are sampled where not") {
  const Exemplar quarter{two_maps({16, 8}, 4, 1), nullptr}, half{two_maps({12, 20}, 2, 2), nullptr};
  const Atlas atlas = make_atlas({quarter, half}, 3, Outside::clamp);
  const Size size = atlas.material->size();
  const ImagePtr height = atlas.material->find("height");
  REQUIRE(height->size() == Size{size.width / 2, size.height / 2});
  for (const Rect& r : atlas.places) CHECK((r.x % 2 == 0 && r.y % 2 == 0));
  const auto halved = [](const Rect& r) { return Rect{r.x / 2, r.y / 2, r.width / 2, r.height / 2}; };
  CHECK(shows(*height, halved(atlas.places[1]), *half.material->find("height")));
  const std::vector<float> doubled = height->read(halved(atlas.places[0]));
  const std::vector<float> own = quarter.material->find("height")->pixels();
  for (int y = 0; y < 4; y++)
    for (int x = 0; x < 8; x++) REQUIRE(doubled[size_t(y * 8 + x)] == own[size_t(y / 2 * 4 + x / 2)]);
}

TEST_CASE("an atlas is the same in tiles and as a whole") {
  const Atlas atlas =
      make_atlas({{two_maps({16, 9}, 1, 1), nullptr}, {two_maps({7, 22}, 1, 2), nullptr}}, 5, Outside::wrap);
  for (const Map& m : atlas.material->maps()) check_tiles_agree(*m.image);
  check_tiles_agree(*atlas.mask);
  check_tiles_agree(*atlas.labels);
}

TEST_CASE("maps are brought to the first exemplar's normal convention and colour space") {
  const auto tilted = [](NormalY normal_y, const std::string& space) {
    ImageInfo info{.size = {4, 4}, .channels = 3, .semantic = Semantic::normal, .normal_y = normal_y};
    std::vector<float> pixels(48);
    for (int i = 0; i < 16; i++) encode_normal({0, 0.6f, 0.8f}, normal_y, &pixels[size_t(i) * 3]);
    return material_of("", {{"normal", Image::from_floats(info, pixels)},
                            {"base_color", flat_image({4, 4}, {0.5f, 0.5f, 0.5f}, Semantic::base_color, space)}});
  };
  const Atlas atlas =
      make_atlas({{tilted(NormalY::down, "srgb_texture"), nullptr}, {tilted(NormalY::up, "lin_rec709"), nullptr}}, 0,
                 Outside::clamp);
  const ImagePtr normal = atlas.material->find("normal"), color = atlas.material->find("base_color");
  CHECK(normal->info().normal_y == NormalY::down);
  const Rect& second = atlas.places[1];
  CHECK(decode_normal(normal->read({second.x, second.y, 1, 1}).data(), NormalY::down)[1] == doctest::Approx(0.6));
  CHECK(color->info().color_space == "srgb_texture");
  CHECK(color->read({second.x, second.y, 1, 1}).front() == doctest::Approx(0.7354).epsilon(1e-3));
}

TEST_CASE("materials that do not go together are refused with what differs") {
  const MaterialPtr full = two_maps({8, 8}, 1, 1);
  const MaterialPtr color_only = Material::of(full->find("base_color"));
  const MaterialPtr other = material_of(
      "mossy", {{"base_color", full->find("base_color")}, {"opacity", noise_image({8, 8}, 1, Semantic::opacity)}});
  const MaterialPtr grey =
      material_of("", {{"base_color", noise_image({8, 8}, 1, Semantic::base_color)}, {"height", full->find("height")}});
  const auto refused = [&](const MaterialPtr& second, const char* message) {
    CHECK_THROWS_WITH_AS(make_atlas({{full, nullptr}, {second, nullptr}}, 0, Outside::clamp),
                         doctest::Contains(message), Error);
  };
  refused(color_only, "base_color, height as in the first; material 2 (\"base_color\") lacks \"height\"");
  refused(other, "material 2 (\"mossy\") lacks \"height\", also has \"opacity\"");
  refused(grey, "base_color with 3 channels in the first; in material 2 it is base_color with 1");
}

TEST_CASE("an atlas larger than 65536 pixels a side is refused") {
  const auto long_one = Image::computed({.size = {60000, 60000}, .channels = 1, .semantic = Semantic::height}, Digest{},
                                        [](const Rect& r, float* out) { std::fill_n(out, r.area(), 0.f); });
  const Exemplar e{Material::of(long_one), nullptr};
  CHECK_THROWS_WITH_AS(make_atlas({e, e}, 0, Outside::clamp), doctest::Contains("more than 65536 a side"), Error);
}
