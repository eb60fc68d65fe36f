#include "core/stochastic/method.h"

#include <cmath>

#include <doctest/doctest.h>

#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

double grain(int x, int y) {
  double sum = 0;
  for (int dy = -2; dy <= 2; dy++)
    for (int dx = -2; dx <= 2; dx++) sum += unit_double(random_bits(7, x + dx, y + dy));
  return sum / 25;
}

FeaturesPtr features_of(Size size, const std::function<double(int, int)>& value) {
  return plain_features(make_image(size, 1, [&](int x, int y, int) { return float(value(x, y)); }));
}

/// Fine grain with scratches: lines a few pixels long in many places.
double scratched(int x, int y) {
  for (int i = 0; i < 12; i++)
    if (random_bits(9, x - i, y) % 400 == 0) return 1;
  return 0.4 * grain(x, y);
}

}  // namespace

TEST_CASE("Gaussian grain has no structure, whatever its histogram; scratches are structure") {
  const Size size{256, 200};
  CHECK(structure(*features_of(size, grain), Task()) < 0.15);
  CHECK(structure(*features_of(size, [](int x, int y) { return std::exp(9 * grain(x, y)); }), Task()) < 0.15);
  CHECK(structure(*features_of(size, scratched), Task()) > 1);
}

TEST_CASE("structure is seen at the scale at which it is, up to a quarter of the side") {
  const auto speckled = [](int x, int y) { return grain(x, y) + (random_bits(4, x / 6, y / 6) % 60 == 0 ? 2 : 0); };
  CHECK(structure(*features_of({512, 512}, speckled), Task()) > 0.5);
  CHECK(structure(*features_of({1024, 1024}, grain), Task()) < 0.5);
}

TEST_CASE("what is all one value, or too small to tell, has no structure and is laid out if it is small") {
  CHECK(structure(*features_of({128, 128}, [](int, int) { return 0.5; }), Task()) == 0);
  const FeaturesPtr small = features_of({63, 200}, grain);
  CHECK(structure(*small, Task()) == 0);
  CHECK(suitable_method(*small, Task()).method == Method::layout);
  CHECK(suitable_method(*small, Task()).why == "it is too small to tell whether it has structure");
}

TEST_CASE("noise suits what has no lattice, no elements and no structure, and the reason is said") {
  const FeaturesPtr plain = features_of({128, 128}, grain);
  const MethodChoice noise = suitable_method(*plain, Task());
  CHECK(noise.method == Method::noise);
  CHECK(noise.sentence().starts_with("noise by example suits it: it has no lattice, no elements and hardly any"));

  const MethodChoice laid = suitable_method(*features_of({128, 128}, scratched), Task());
  CHECK(laid.method == Method::layout);
  CHECK(laid.why.starts_with("its features stand out (structure 0."));

  const MethodChoice repeats = suitable_method(*plain->with(Lattice{2, {16, 0}, {0, 16}, 0.5}), Task());
  CHECK(repeats.method == Method::layout);
  CHECK(repeats.sentence() == "a layout suits it: it repeats");

  Elements two{plain->size(), std::vector<uint16_t>(128 * 128), 2, 0.9};
  two.at[0] = 1;
  const MethodChoice whole = suitable_method(*plain->with(std::make_shared<const Elements>(two)), Task());
  CHECK(whole.method == Method::layout);
  CHECK(whole.why == "its 2 elements stay whole");
}

TEST_CASE("structure is told as a share, however far from Gaussian an exemplar is") {
  const auto line = [](int x, int y) { return x == 64 && y > 20 && y < 100 ? 1.0 : 0.001 * grain(x, y); };
  const FeaturesPtr features = features_of({128, 128}, line);
  CHECK(structure(*features, Task()) > 1);
  const std::string why = suitable_method(*features, Task()).why;
  CAPTURE(why);
  CHECK(why.starts_with("its features stand out (structure 0."));
  CHECK(why.ends_with(" of 1, above 0.14)"));
}

TEST_CASE("looking for structure can be cancelled") {
  const std::atomic<bool> cancelled{true};
  CHECK_THROWS_AS(structure(*features_of({128, 128}, grain), Task(&cancelled, {})), Cancelled);
}

TEST_CASE("a layout suits streaks, which noise would blur") {
  const FeaturesPtr metal = plain_features(brushed({192, 160}));
  Repeats repeats;
  repeats.streaks.x = 4;
  const MethodChoice choice = suitable_method(*metal->with(repeats), Task());
  CHECK(choice.method == Method::layout);
  CHECK(choice.why == "it has streaks");
}
