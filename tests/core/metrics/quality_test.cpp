#include "core/metrics/quality.h"

#include <atomic>
#include <map>

#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include "tests/core/metrics/textures.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

MaterialPtr material(const Planes& planes) {
  const ImageInfo info{.size = planes.size, .channels = planes.channels};
  return Material::of(Image::from_floats(info, planes.values));
}

Planes part_of(const Planes& image, const Rect& part) {
  Planes out = Planes::zeros({part.width, part.height}, image.channels);
  for (int y = 0; y < part.height; y++)
    std::copy_n(image.at(part.x, part.y + y), size_t(part.width) * image.channels, out.at(0, y));
  return out;
}

/// With a bright disc on it.
Planes with_disc(Planes image) {
  constexpr int radius = 14;
  for (int y = -radius; y <= radius; y++)
    for (int x = -radius; x <= radius; x++)
      if (x * x + y * y <= radius * radius) image.at(40 + x, 64 + y)[0] = 1;
  return image;
}

QualityFigures measured(const Planes& exemplar, const Planes& output, bool wraps = false) {
  ComparedPlanes planes = compared_planes(*material(exemplar), *material(output), {});
  planes.exemplar.wraps = wraps;
  return measure_quality(std::move(planes.exemplar), std::move(planes.output), {}, Task());
}

/// Outputs of known worth for a 64x64 exemplar of bricks.
const std::map<std::string, QualityFigures>& calibration() {
  static const std::map<std::string, QualityFigures> all = [] {
    const Size size{96, 96};
    const Planes exemplar = bricks({64, 64}, 1), sample = bricks(size, 5);
    return std::map<std::string, QualityFigures>{
        {"tiling", measured(exemplar, tiled(exemplar, size))},
        {"sample", measured(exemplar, sample)},
        {"blocks", measured(exemplar, random_blocks(exemplar, size, 16, 3))},
        {"blur", measured(exemplar, blurred(sample, 2, Beyond::mirrored, Task()))},
        {"shuffled", measured(exemplar, shuffled(tiled(exemplar, size), 4))},
        {"different", measured(exemplar, spots(size, 2))},
    };
  }();
  return all;
}

/// Whether every output of a group has a clearly (10 %) lower figure than every output of the next group.
void check_order(double QualityFigures::*figure, const std::vector<std::vector<std::string>>& groups) {
  for (size_t g = 0; g + 1 < groups.size(); g++)
    for (const std::string& a : groups[g])
      for (const std::string& b : groups[g + 1]) {
        INFO(a << " against " << b);
        CHECK(calibration().at(a).*figure * 1.1 < calibration().at(b).*figure);
      }
}

}  // namespace

TEST_CASE("a thing compared with itself has no distance, though not all of its patches are looked at") {
  const Planes image = bricks({160, 170}, 1);
  const QualityFigures q = measured(image, image);
  CHECK(q.swd == 0);
  CHECK(q.coherence == 0);
  CHECK(q.completeness == 0);
  CHECK(q.broken == 0);
  CHECK(q.structure == 0);
}

TEST_CASE("distances of distributions rise from tiling over a new sample to spoilt outputs") {
  check_order(&QualityFigures::swd, {{"tiling"}, {"sample", "blocks"}, {"shuffled"}, {"different", "blur"}});
  check_order(&QualityFigures::cooccurrence, {{"tiling"}, {"sample", "blocks"}, {"shuffled"}, {"different", "blur"}});
}

TEST_CASE("patch similarity tells whole features from cut, smeared and foreign ones") {
  check_order(&QualityFigures::coherence, {{"tiling"}, {"sample"}, {"blocks"}, {"blur", "shuffled"}, {"different"}});
  check_order(&QualityFigures::completeness, {{"tiling"}, {"blocks", "sample"}, {"blur", "shuffled"}, {"different"}});
  check_order(&QualityFigures::broken, {{"tiling"}, {"sample"}, {"blocks"}, {"blur", "shuffled", "different"}});
}

TEST_CASE("pieces are as good at any pixel") {
  const Planes exemplar = bricks({128, 128}, 1), tiling = tiled(exemplar, {259, 259});
  for (int by = 0; by < 4; by++) {
    CAPTURE(by);
    const QualityFigures q = measured(exemplar, part_of(tiling, {by, by, 256, 256}));
    CHECK(q.coherence < 0.25);  // where copies meet there are new windows
    CHECK(q.completeness < 0.05);
    CHECK(q.broken < 0.04);
  }
}

TEST_CASE("what lies across the border of an exemplar that tiles is part of it") {
  const Planes exemplar = bricks({128, 128}, 1), tiling = tiled(exemplar, {259, 259});
  for (int by = 0; by < 4; by++) {
    CAPTURE(by);
    const Planes part = part_of(tiling, {by, by, 256, 256});
    const QualityFigures q = measured(exemplar, part, true), cut = measured(exemplar, part);
    CHECK(q.coherence < cut.coherence / 5);
    CHECK(q.completeness < 0.02);
    CHECK(q.broken < cut.broken / 2);
  }
  CHECK(measured(exemplar, exemplar).completeness == 0);
  CHECK(measured(exemplar, exemplar, true).completeness > 0.01);
  CHECK(measured(exemplar, exemplar, true).coherence < 0.06);
}

TEST_CASE("what is missing is missing at any pixel") {
  const Planes whole = with_disc(bricks({128, 128}, 1));
  const Planes without = tiled(bricks({128, 128}, 1), {259, 259}), with = tiled(whole, {259, 259});
  for (int by = 0; by < 4; by++) {
    CAPTURE(by);
    const Rect part{by, by, 256, 256};
    CHECK(measured(whole, part_of(with, part)).completeness < 0.1);
    CHECK(measured(whole, part_of(without, part)).completeness > 0.3);
  }
}

TEST_CASE("autocorrelation tells whether courses were kept") {
  check_order(&QualityFigures::acf, {{"tiling"}, {"sample"}, {"blocks", "blur"}, {"shuffled"}, {"different"}});
}

TEST_CASE("structure tells whole courses from cut, smeared and foreign ones") {
  check_order(&QualityFigures::structure, {{"tiling"}, {"sample"}, {"blocks"}, {"blur", "shuffled", "different"}});
}

TEST_CASE("windows of structure are as large as elements that are known, else as the texture's correlation") {
  const Planes exemplar = bricks({128, 128}, 1), output = random_blocks(exemplar, {160, 160}, 40, 3);
  const auto structure = [&](const QualityParts& parts) {
    ComparedPlanes planes = compared_planes(*material(exemplar), *material(output), {});
    return measure_quality(std::move(planes.exemplar), std::move(planes.output), parts, Task()).structure;
  };
  const double small = structure({.verbatim = false, .element = 14}), large = structure({.element = 64});
  CHECK(small > 0);
  CHECK(large > small);
  CHECK(structure({}) > 0);
}

TEST_CASE("copies and repeats are found in a tiling and not in a new sample") {
  check_order(&QualityFigures::verbatim, {{"shuffled"}, {"blocks"}, {"sample"}, {"tiling"}});
  CHECK(calibration().at("tiling").verbatim > 0.4);
  CHECK(calibration().at("tiling").repeat > 0.03);
  for (const char* other : {"sample", "blocks", "blur", "shuffled"}) CHECK(calibration().at(other).repeat < 0.01);
}

TEST_CASE("an exemplar compared with itself has no faults") {
  const Planes exemplar = spots({64, 64}, 1);
  const QualityFigures q = measured(exemplar, exemplar);
  CHECK(q.coherence == 0);
  CHECK(q.completeness == 0);
  CHECK(q.broken == 0);
  CHECK(q.cooccurrence == 0);
  CHECK(q.acf == 0);
  CHECK(q.repeat == 0);
  CHECK(q.verbatim == doctest::Approx(26.0 / 32));  // 32 - 6 positions of whole patches at half size
}

TEST_CASE("figures agree with an independent implementation in NumPy") {
  const QualityFigures sample = calibration().at("sample"), blocks = calibration().at("blocks");
  CHECK(sample.swd == doctest::Approx(0.1215).epsilon(0.06));
  CHECK(sample.coherence == doctest::Approx(1.108).epsilon(0.02));
  CHECK(sample.completeness == doctest::Approx(0.925).epsilon(0.02));
  CHECK(sample.acf == doctest::Approx(0.0155).epsilon(0.01));
  CHECK(sample.broken == doctest::Approx(0.0953).epsilon(0.1));
  CHECK(sample.verbatim == doctest::Approx(0.153).epsilon(0.02));
  CHECK(blocks.swd == doctest::Approx(0.0987).epsilon(0.06));
  CHECK(blocks.acf == doctest::Approx(0.1527).epsilon(0.001));
  CHECK(blocks.broken == doctest::Approx(0.6698).epsilon(0.02));
  CHECK(calibration().at("tiling").repeat == doctest::Approx(0.049).epsilon(0.02));
}

TEST_CASE("figures do not depend on the number of threads") {
  const Planes exemplar = bricks({40, 48}, 1), output = random_blocks(exemplar, {70, 50}, 9, 1);
  const auto run = [&](int threads) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const QualityFigures q = measured(exemplar, output);
    return std::vector<double>{q.swd,       q.cooccurrence, q.coherence, q.completeness, q.broken,
                               q.structure, q.acf,          q.verbatim,  q.repeat};
  };
  CHECK(run(1) == run(4));
}

TEST_CASE("the smallest images can be measured") {
  const QualityFigures q = measured(bricks({16, 16}, 1), bricks({16, 30}, 2));
  CHECK(q.swd > 0);
  CHECK(q.swd < 1);
}

TEST_CASE("measuring stops when it is cancelled") {
  const std::atomic<bool> cancelled{true};
  CHECK_THROWS_AS(measure_quality(bricks({64, 64}, 1), bricks({64, 64}, 2), {}, Task(&cancelled, nullptr)), Cancelled);
}

TEST_CASE("maps of other sizes are brought to the material's size, and normals to one convention") {
  const auto normal = [](Size size, NormalY convention) {
    const ImagePtr image = make_image(
        size, 3,
        [&](int x, int y, int c) {
          const float v = c == 1 ? 0.2f + 0.05f * float(y % 3) : 0.3f + 0.1f * float(x % 4);
          return c == 1 && convention == NormalY::down ? 1 - v : v;
        },
        Semantic::normal);
    ImageInfo info = image->info();
    info.normal_y = convention;
    return Image::redescribed(image, info);
  };
  const Planes height = bricks({32, 32}, 1);
  const ImagePtr small = material(resampled(height, {16, 16}))->maps()[0].image;
  const auto a = Material::make("a", {{"normal", normal({32, 32}, NormalY::up)}, {"height", small}});
  const auto b = Material::make("b", {{"height", small}, {"normal", normal({32, 32}, NormalY::down)}});
  const ComparedPlanes planes = compared_planes(*a, *b, {});
  CHECK(planes.exemplar.channels == 4);
  CHECK(planes.exemplar.size == Size{32, 32});
  double worst = 0;
  for (size_t i = 0; i < planes.exemplar.values.size(); i++)
    worst = std::max(worst, double(std::abs(planes.exemplar.values[i] - planes.output.values[i])));
  CHECK(worst < 1e-4);
}
