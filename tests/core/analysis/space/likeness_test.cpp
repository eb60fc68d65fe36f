#include "core/analysis/space/likeness.h"

#include <doctest/doctest.h>

#include "core/analysis/space/planes.h"
#include "core/filter/resample.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

Fingerprint fingerprint(const Material& material, const ImagePtr& mask = nullptr) {
  const FeaturesPtr features = weighted_features(material, {}, false, mask);
  return fingerprint_of(*features, unmasked_planes(*features, Task()));
}

/// Bumps at random places.
ImagePtr bumps(Size size, uint64_t seed, Semantic semantic = Semantic::height) {
  return make_image(
      size, 1, [&](int x, int y, int) { return float(unit_double(random_bits(seed, x / 8, y / 8))); }, semantic);
}

MaterialPtr material(const ImagePtr& colour, const ImagePtr& height) {
  return Material::make("m", {{"base_color", colour}, {"height", height}});
}

ImagePtr at_size(const ImagePtr& image, Size size) {
  return resampled(image, size, "auto", Outside::clamp, Hasher().add("at size").add(image->digest()).digest());
}

}  // namespace

TEST_CASE("an exemplar is like itself: larger, smaller, inverted, and by one map alone") {
  constexpr Size size{96, 64};
  const MaterialPtr m = material(wall(size), bumps(size, 1));
  const Fingerprint f = fingerprint(*m);
  CHECK(f.cells == Size{24, 16});
  CHECK(likeness(f, *m, Task())->correlation > 0.95);
  for (const Size other : {Size{192, 128}, Size{48, 32}, Size{144, 96}})
    CHECK(likeness(f, *Material::make("m", {{"height", at_size(bumps(size, 1), other)}}), Task())->correlation > 0.9);
  const ImagePtr valleys = make_image(
      size, 1, [&](int x, int y, int) { return 1 - bumps(size, 1)->pixels()[size_t(y) * size.width + x]; },
      Semantic::height);
  CHECK(likeness(f, *Material::of(valleys), Task())->correlation > 0.99);
  // A map that was painted anew does not matter as long as another is the same.
  CHECK(likeness(f, *material(wall(size), bumps(size, 2)), Task())->correlation > 0.95);
}

TEST_CASE("an exemplar of one mean everywhere is like itself by the contrast of its grain") {
  constexpr Size size{96, 64};
  const auto grain = [&](uint64_t seed) {
    return make_image(
        size, 3,
        [&](int x, int y, int) {
          const float spread = 0.06f * float(unit_double(random_bits(seed, x / 8, y / 8)));
          return (x + y) % 2 == 0 ? 0.06f - spread : 0.06f + spread;
        },
        Semantic::base_color);
  };
  const Fingerprint f = fingerprint(*Material::of(grain(1)));
  CHECK(likeness(f, *Material::of(grain(1)), Task())->correlation > 0.95);
  CHECK(likeness(f, *Material::of(grain(2)), Task())->correlation < least_likeness());
}

TEST_CASE("another exemplar is not like it") {
  constexpr Size size{96, 64};
  const Fingerprint f = fingerprint(*Material::of(bumps(size, 1)));
  for (uint64_t seed = 2; seed < 30; seed++) {
    const std::optional<Likeness> other = likeness(f, *Material::of(bumps(size, seed)), Task());
    CHECK(other->correlation < least_likeness());
    CHECK(other->maps == std::vector<std::string>{"height"});
  }
}

TEST_CASE("light that falls off towards the sides makes no two exemplars alike") {
  const auto lit = [](uint64_t seed) {
    const ImagePtr even = bumps({128, 128}, seed);
    return make_image(
        {128, 128}, 1,
        [&](int x, int y, int) {
          const double r = std::hypot(x - 64, y - 64) / 64;
          return float(0.2 * even->pixels()[size_t(y) * 128 + x] - r * r);
        },
        Semantic::height);
  };
  const Fingerprint f = fingerprint(*Material::of(lit(1)));
  CHECK(likeness(f, *Material::of(lit(1)), Task())->correlation > 0.99);
  CHECK(likeness(f, *Material::of(lit(2)), Task())->correlation < least_likeness());
}

TEST_CASE("what cannot be compared is not judged") {
  constexpr Size size{96, 64};
  const Fingerprint f = fingerprint(*Material::of(bumps(size, 1)));
  CHECK_FALSE(likeness(f, *Material::of(wall(size)), Task()));  // no map of that name
  const Fingerprint small = fingerprint(*Material::of(bumps({24, 24}, 1)));
  CHECK_FALSE(likeness(small, *Material::of(bumps({24, 24}, 2)), Task()));
  const ImagePtr flat = make_image(
      size, 1, [](int, int, int) { return 0.5f; }, Semantic::height);
  CHECK(likeness(f, *Material::of(flat), Task())->correlation == 0);  // it is surely another
  CHECK(fingerprint(*Material::of(flat)).channels.empty());
}

TEST_CASE("pixels outside a mask count for a fingerprint as any others") {
  constexpr Size size{96, 64};
  const ImagePtr left = make_image(
      size, 1, [](int x, int, int) { return x < 48 ? 1.0f : 0.0f; }, Semantic::mask);
  const MaterialPtr m = Material::of(bumps(size, 1));
  CHECK(likeness(fingerprint(*m, left), *m, Task())->correlation > 0.99);
}
