#include "core/filter/opacity_weights.h"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "core/filter/mip_levels.h"
#include "core/filter/resample.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr std::array<float, 3> green = {0.1f, 0.5f, 0.2f};

bool is_leaf(int x, int y) {
  return (x - 20) * (x - 20) + (y - 17) * (y - 17) * 2 < 150;
}

/// A green leaf on hidden white. `channels`: 4 with its opacity in alpha, 3 without.
ImagePtr leaf(int channels, Size size = {45, 37}) {
  return make_image(
      size, channels,
      [](int x, int y, int c) {
        const bool seen = is_leaf(x, y);
        return c == 3 ? float(seen) : seen ? green[size_t(c)] : 1.0f;
      },
      Semantic::base_color, "srgb_texture");
}

ImagePtr opacity(Size size = {45, 37}) {
  return make_image(
      {size}, 1, [](int x, int y, int) { return float(is_leaf(x, y)); }, Semantic::opacity);
}

/// How far any pixel, of all or of those with alpha, is from green.
float most_fringe(const Image& image, bool all = true) {
  const std::vector<float> p = image.pixels();
  float most = 0;
  for (size_t i = 0; i < p.size(); i += size_t(image.channels()))
    for (size_t c = 0; c < 3; c++)
      if (all || p[i + 3] > 1.0f / 255) most = std::max(most, std::fabs(p[i + c] - green[c]));
  return most;
}

}  // namespace

TEST_CASE("below a leaf on hidden white, all mip levels are green, whether its opacity is in alpha or beside it") {
  for (const int channels : {4, 3}) {
    CAPTURE(channels);
    const ImagePtr image = leaf(channels), weights = opacity_weights(image, opacity());
    REQUIRE(weights);
    const std::vector<ImagePtr> levels = mip_levels(image, weights), plain = mip_levels(image);
    REQUIRE(levels.size() == plain.size());
    CHECK(levels.front()->pixels() == image->pixels());
    CHECK(most_fringe(*plain[1]) > 0.5f);
    for (size_t i = 1; i < levels.size(); i++) {
      CHECK(levels[i]->info() == plain[i]->info());
      CHECK(most_fringe(*levels[i]) < 1e-3f);
      if (channels == 3) continue;
      const std::vector<float> a = levels[i]->pixels(), b = plain[i]->pixels();
      for (size_t k = 3; k < a.size(); k += 4) CHECK(a[k] == doctest::Approx(b[k]).epsilon(1e-4));
    }
  }
}

TEST_CASE("a faint pixel among hidden ones decides its mip level's colour") {
  const ImagePtr image = make_image(
      {2, 2}, 4, [](int x, int y, int c) { return x + y > 0 ? float(c != 3)
                                                  : c == 3  ? 0.25f
                                                  : c == 0  ? 0.5f
                                                            : 0.0f; },
      Semantic::base_color, "lin_rec709");
  const std::vector<float> last = mip_levels(image, opacity_weights(image, nullptr)).back()->pixels();
  CHECK(last[0] == doctest::Approx(0.5));
  CHECK(last[1] == doctest::Approx(0.0));
  CHECK(last[3] == doctest::Approx(0.0625));
}

TEST_CASE("scaled by weight, what is seen of a leaf stays green with every filter, smaller and larger") {
  const Digest recipe = Hasher().add("test").digest();
  for (const std::string& filter : scaling_filter_names())
    for (const Size size : {Size{20, 16}, Size{70, 80}, Size{1, 1}}) {
      CAPTURE(filter);
      const ImagePtr image = leaf(4);
      const ImagePtr scaled =
          resampled_by_weight(image, opacity_weights(image, nullptr), size, filter, Outside::clamp, recipe);
      CHECK(scaled->size() == size);
      CHECK(most_fringe(*scaled, false) < 1e-3f);
    }
}

TEST_CASE("nothing is weighted where opacity tells nothing apart") {
  const auto flat = [](float v) {
    return make_image(
        {4, 4}, 1, [v](int, int, int) { return v; }, Semantic::opacity);
  };
  const ImagePtr colours = leaf(3, {4, 4});
  CHECK_FALSE(opacity_weights(colours, nullptr));
  CHECK_FALSE(opacity_weights(colours, flat(1)));
  CHECK_FALSE(opacity_weights(colours, flat(0)));
  CHECK(opacity_weights(colours, flat(0.5f)));
  CHECK_FALSE(opacity_weights(opacity(), opacity()));
  CHECK(opacity_weights(colours, opacity())->size() == colours->size());
}
