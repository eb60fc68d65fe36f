// The kernels of analysis and synthesis one by one, on a generated exemplar. Run with --benchmark_filter=... for some.

#include <map>

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "core/analysis/elements/find_elements.h"
#include "core/analysis/space/appearance_space.h"
#include "core/analysis/space/k_coherence.h"
#include "core/analysis/space/weighting.h"
#include "core/base/hash.h"
#include "core/exemplar/lattice.h"
#include "core/image_io/image_file.h"
#include "core/material/material.h"
#include "core/numeric/principal_components.h"
#include "core/procedural/pattern.h"
#include "core/synthesis/state/comparison_window.h"
#include "core/synthesis/state/pieces.h"
#include "core/synthesis/state/usage_penalty.h"
#include "core/synthesis/steps/correction.h"
#include "core/synthesis/synthesize.h"

using namespace terrazzo;

namespace {

constexpr int similar_per_pixel = 3;

/// Gravel, which does not repeat. `maps`: 1 or 5.
FeaturesPtr features_of(int side, int maps) {
  PatternSpec spec;
  spec.type = "gravel";
  spec.size = {side, side};
  spec.tileable = false;
  const MaterialPtr all = make_pattern(spec, Task());
  const MaterialPtr material = maps == 1 ? Material::of(all->find(Semantic::base_color)) : all;
  NumberMap weights;
  for (const Map& map : material->maps()) weights[map.name] = {1.0};
  return weighted_features(*material, weights, false);
}

AppearancePtr appearance_of(int side) {
  static std::map<int, AppearancePtr> made;
  AppearancePtr& appearance = made[side];
  if (!appearance) appearance = make_appearance(*features_of(side, 1), {}, {}, Task());
  return appearance;
}

IndexPtr index_of(int side) {
  static std::map<int, IndexPtr> made;
  IndexPtr& index = made[side];
  if (!index) index = make_index(appearance_of(side), similar_per_pixel, Task());
  return index;
}

void count_items(benchmark::State& state, int64_t items) {
  state.counters["per_item"] =
      benchmark::Counter(double(state.iterations() * items),
                         benchmark::Counter::Flags(benchmark::Counter::kIsRate | benchmark::Counter::kInvert));
}

/// A level of a synthesis from a 256x256 exemplar to 1024x1024 as it is after upsampling: coherent blocks, the larger
/// the finer the level.
struct CorrectionCase {
  IndexPtr index = index_of(256);
  int level;
  PaddedLevel exemplar;
  std::vector<ExemplarPixel> similar;
  Field field;

  explicit CorrectionCase(int l)
      : level(l), exemplar(index->appearance()->levels()[l], false), field{{1024 >> l, 1024 >> l}, {}} {
    for (const uint32_t p : index->levels()[l].positions)
      similar.push_back({uint16_t(p % exemplar.size().width), uint16_t(p / exemplar.size().width)});
    const int block = std::max(2, 40 >> l);
    field.pixels.resize(size_t(field.size.area()));
    for (int y = 0; y < field.size.height; y++)
      for (int x = 0; x < field.size.width; x++) {
        const uint64_t r = random_bits(1, x / block, y / block);
        int u = int(below(uint32_t(r), uint32_t(exemplar.size().width))) + x % block;
        int v = int(below(uint32_t(r >> 32), uint32_t(exemplar.size().height))) + y % block;
        exemplar.settle(u, v);
        field.at(x, y) = {uint16_t(u), uint16_t(v)};
      }
  }
  CorrectionLevel correction_level() const {
    return {exemplar, similar, index->levels()[size_t(level)].per_pixel, level, PlaneWindow::all_of({field.size}), {},
            {},       nullptr};
  }
};

void correction_pass(benchmark::State& state) {
  const CorrectionCase c(int(state.range(0)));
  const int level = c.level;
  const CorrectionPass pass{.window = level == 0 ? &sparse_window() : &full_window(),
                            .coherence = unit_factor / 2,
                            .random_candidates = level >= 3   ? 24
                                                 : level == 2 ? 8
                                                              : 0,
                            .seed = 1,
                            .wanted = whole(c.field.size)};
  for (auto _ : state) {
    state.PauseTiming();
    Field field = c.field;
    UsagePenalty usage(c.exemplar.size(), level > 0 ? 0.7 : 0, 0.75);
    state.ResumeTiming();
    correct(field, c.correction_level(), pass, usage, Task());
    benchmark::DoNotOptimize(field.pixels.data());
  }
  count_items(state, c.field.size.area());
}
BENCHMARK(correction_pass)->DenseRange(0, 4)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

/// Brings places into phase with a skew lattice. Arguments: the level; cells are too small to see from level 3 on.
void lattice_snap(benchmark::State& state) {
  const LatticePhase phase({2, {12.4, 3.1}, {-4.2, 13.7}, 0.5}, int(state.range(0)), {{1024, 1024}, false, false});
  int at = 0;
  for (auto _ : state) {
    int u = at % 61, v = at % 53;
    phase.snap(at % 128, at / 128 % 128, u, v);
    benchmark::DoNotOptimize(u + v);
    at++;
  }
  count_items(state, 1);
}
BENCHMARK(lattice_snap)->DenseRange(1, 4);

void usage_count(benchmark::State& state) {
  const CorrectionCase c(1);
  UsagePenalty usage(c.exemplar.size(), 0.7, 0.75);
  for (auto _ : state) usage.recount(c.field, {});
  count_items(state, c.field.size.area());
}
BENCHMARK(usage_count)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

void piece_labels(benchmark::State& state) {
  const CorrectionCase c(2);
  for (auto _ : state) benchmark::DoNotOptimize(Pieces(c.field, c.correction_level()).count());
  count_items(state, c.field.size.area());
}
BENCHMARK(piece_labels)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

/// Of vectors as long as a 5x5 window of that many channels is.
void components(benchmark::State& state) {
  const int n = 25 * int(state.range(0));
  std::vector<float> samples(size_t(12000) * n);
  for (size_t i = 0; i < samples.size(); i++) samples[i] = float(unit_double(random_bits(1, i)) * (i % n));
  for (auto _ : state) benchmark::DoNotOptimize(principal_components(samples, n, appearance_dimensions).total_variance);
  count_items(state, int64_t(samples.size()) / n);
}
BENCHMARK(components)->Arg(3)->Arg(9)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

/// Arguments: the exemplar's side, its number of maps.
void appearance(benchmark::State& state) {
  const FeaturesPtr features = features_of(int(state.range(0)), int(state.range(1)));
  for (auto _ : state) benchmark::DoNotOptimize(make_appearance(*features, {}, {}, Task()).get());
  count_items(state, features->size().area());
}
BENCHMARK(appearance)
    ->ArgsProduct({{256, 512, 1024, 2048}, {1, 5}})
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

void k_coherent_candidates(benchmark::State& state) {
  const AppearancePtr a = appearance_of(int(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(make_index(a, similar_per_pixel, Task()).get());
  count_items(state, a->size().area());
}
BENCHMARK(k_coherent_candidates)
    ->RangeMultiplier(2)
    ->Range(256, 2048)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

/// Arguments: the result's side, the number of threads.
void synthesis(benchmark::State& state) {
  const int side = int(state.range(0));
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(state.range(1)));
  const IndexPtr index = index_of(256);
  for (auto _ : state) benchmark::DoNotOptimize(synthesize(*index, {.size = {side, side}}, Task()).get());
  count_items(state, int64_t{side} * side);
}
BENCHMARK(synthesis)
    ->ArgsProduct({{512, 1024, 2048}, {1, 2}})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

/// The generated wall: courses of 21 pixels to 256, bricks of three times that.
IndexPtr wall_of(int side) {
  static std::map<int, IndexPtr> made;
  IndexPtr& index = made[side];
  if (index) return index;
  PatternSpec spec;
  spec.size = {side, side};
  const MaterialPtr material = Material::of(make_pattern(spec, Task())->find(Semantic::base_color));
  const double course = side / 12.0;
  const FeaturesPtr features =
      weighted_features(*material, {{material->maps()[0].name, {1.0}}}, false)->with(Lattice{1, {0, course}, {}, 0.9});
  const FeaturesPtr known = features->with(find_elements(*features, Task()));
  index = make_index(make_appearance(*known, {}, {}, Task()), similar_per_pixel, Task());
  return index;
}

/// From 256x256 to a square of that side, without and with bricks laid whole.
void wall(benchmark::State& state) {
  const IndexPtr index = wall_of(256);
  const int side = int(state.range(0));
  const SynthesisOptions options{.size = {side, side}, .whole_bricks = state.range(1) != 0};
  for (auto _ : state) benchmark::DoNotOptimize(synthesize(*index, options, Task()).get());
  count_items(state, options.size.area());
}
BENCHMARK(wall)->ArgsProduct({{512, 1024, 2048}, {0, 1}})->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

void png_writing(benchmark::State& state) {
  PatternSpec spec;
  spec.type = "gravel";
  spec.size = {1024, 1024};
  const ImagePtr image = make_pattern(spec, Task())->find(Semantic::base_color);
  for (auto _ : state) benchmark::DoNotOptimize(encoded_file(*image).size());
  count_items(state, spec.size.area());
}
BENCHMARK(png_writing)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
