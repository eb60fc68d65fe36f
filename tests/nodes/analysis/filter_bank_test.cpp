#include "core/analysis/space/filter_bank.h"

#include <cmath>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "tests/exemplars.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

Planes planes_of(Size size, bool wraps, const std::function<float(int, int)>& value) {
  Planes p{size, 1, wraps, std::vector<float>(size_t(size.area()))};
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) *p.at(x, y) = value(x, y);
  return p;
}

Planes noise_planes(Size size, bool wraps) {
  return planes_of(size, wraps, [](int x, int y) { return float(unit_double(random_bits(1, x, y))); });
}

/// The paper's filters, written down once more: 49x49, zero mean, L1 norm 1; order 0 is the blob.
std::vector<double> reference_filter(double deviation, int orientation, int order) {
  std::vector<double> f;
  const double angle = orientation * 3.14159265358979 / 6;
  for (int y = -24; y <= 24; y++)
    for (int x = -24; x <= 24; x++) {
      const double u = x * std::cos(angle) + y * std::sin(angle), v = y * std::cos(angle) - x * std::sin(angle);
      const double along = order ? 3 * deviation : deviation;
      const double g = std::exp(-u * u / (2 * along * along) - v * v / (2 * deviation * deviation));
      const double factor = order == 0 ? 1 : order == 1 ? v : deviation * deviation - v * v;
      f.push_back(factor * g);
    }
  double mean = 0, norm = 0;
  for (const double v : f) mean += v / double(f.size());
  for (double& v : f) norm += std::fabs(v -= mean);
  for (double& v : f) v /= norm;
  return f;
}

double respond(const Planes& image, const std::vector<double>& filter, int x, int y) {
  double sum = 0;
  for (int j = -24; j <= 24; j++)
    for (int i = -24; i <= 24; i++)
      sum += filter[size_t((j + 24) * 49 + i + 24)] * double(*image.at(image.column(x + i), image.row(y + j)));
  return sum;
}

}  // namespace

TEST_CASE("responses are those of the filters, taken one by one, at borders and block borders too") {
  for (const bool wraps : {false, true}) {
    const Planes image = noise_planes({230, 40}, wraps);
    const FilterResponses r = mr8_responses(image, 1, {});
    for (const auto [x, y] : {std::array{0, 0}, std::array{207, 21}, std::array{208, 39}}) {
      const size_t pixel = size_t(y) * 230 + size_t(x);
      for (size_t s = 0; s < 3; s++) {
        double edge = 0, bar = 0;
        for (int o = 0; o < 6; o++) {
          edge = std::max(edge, std::fabs(respond(image, reference_filter(1 << s, o, 1), x, y)));
          const double b = respond(image, reference_filter(1 << s, o, 2), x, y);
          if (std::fabs(b) > std::fabs(bar)) bar = b;
        }
        CHECK(double(r.edges[3 * pixel + s]) == doctest::Approx(edge).epsilon(1e-5));
        CHECK(double(r.bars[3 * pixel + s]) == doctest::Approx(bar).epsilon(1e-5));
      }
      CHECK(double(r.blobs[2 * pixel]) == doctest::Approx(respond(image, reference_filter(10, 0, 0), x, y)));
    }
  }
}

TEST_CASE("a flat image gives no response, and no response exceeds the image's range") {
  for (const float v : mr8_responses(planes_of({20, 30}, false, [](int, int) { return 3.f; }), 1, {}).edges)
    CHECK(std::fabs(v) < 1e-6f);
  const FilterResponses r = mr8_responses(noise_planes({40, 40}, true), 0.5, {});
  for (const std::vector<float>* responses : {&r.edges, &r.bars, &r.blobs})
    for (const float v : *responses) REQUIRE(std::fabs(v) <= 1);
}

TEST_CASE("light lines are positive and dark ones negative, whichever way they run; edges have no sign") {
  for (const bool upright : {false, true})
    for (const float line : {1.f, -1.f}) {
      const FilterResponses r = mr8_responses(
          planes_of({64, 64}, false, [&](int x, int y) { return (upright ? x : y) == 32 ? line : 0.f; }), 1, {});
      const size_t pixel = 32 * 64 + 32;
      CHECK(r.bars[3 * pixel] * line > 0.2f);
      CHECK(r.bars[3 * pixel] * line > r.bars[3 * pixel + 2] * line);
      CHECK(r.edges[3 * pixel] < 1e-4f);
      CHECK(r.edges[3 * (pixel + (upright ? 1 : 64))] > 0.1f);
    }
  const FilterResponses blob = mr8_responses(
      planes_of({64, 64}, false, [](int x, int y) { return std::hypot(x - 32, y - 32) < 12 ? 1.f : 0.f; }), 1, {});
  CHECK(blob.blobs[2 * (32 * 64 + 32)] > 0.2f);
  CHECK(blob.blobs[2 * (32 * 64 + 32) + 1] > 0.2f);
}

TEST_CASE("turning the image by a quarter turns the responses and leaves their values") {
  const Planes image = noise_planes({48, 48}, true);
  const Planes turned = planes_of({48, 48}, true, [&](int x, int y) { return *image.at(47 - y, x); });
  const FilterResponses a = mr8_responses(image, 1, {}), b = mr8_responses(turned, 1, {});
  for (int y = 0; y < 48; y++)
    for (int x = 0; x < 48; x++)
      for (int s = 0; s < 3; s++) {
        const size_t p = size_t(y * 48 + x) * 3 + size_t(s), q = size_t(x * 48 + 47 - y) * 3 + size_t(s);
        REQUIRE(std::fabs(b.edges[p] - a.edges[q]) < 1e-6f);
        REQUIRE(std::fabs(b.bars[p] - a.bars[q]) < 1e-6f);
      }
}

TEST_CASE("the filter_bank node gives guidance of the material's size from the map it is told to use") {
  const MaterialPtr material = Material::make("m", {{"height", noise_image({20, 24}, 1, Semantic::height)},
                                                    {"base_color", wall({40, 48})},
                                                    {"normal", noise_image({40, 48}, 3, Semantic::normal)}});
  const NodeRun run = run_node("filter_bank", {}, {{"material", {material}}});
  CHECK(run.get<Image>("edges")->channels() == 3);
  CHECK(run.get<Image>("bars")->channels() == 3);
  CHECK(run.get<Image>("blobs")->channels() == 2);
  for (const std::string port : {"edges", "bars", "blobs"}) {
    CHECK(run.get<Image>(port)->size() == Size{40, 48});
    CHECK(run.get<Image>(port)->info().semantic == Semantic::guidance);
  }
  const NodeRun of_height = run_node("filter_bank", {{"map", std::string("height")}}, {{"material", {material}}});
  CHECK(greatest_difference(*run.get<Image>("edges"), *of_height.get<Image>("edges")) > 0.1);
  CHECK_THROWS_WITH_AS(run_node("filter_bank", {{"map", std::string("normal")}}, {{"material", {material}}}),
                       doctest::Contains("its channels form vectors"), Error);
  check_every_size([](Size size) {
    return run_node("filter_bank", {{"scale", 0.25}}, {{"material", {noise_image(size, 1)}}}).get<Image>("bars");
  });
}
