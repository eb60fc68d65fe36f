#include "core/synthesis/synthesize.h"

#include <cmath>
#include <memory>

#include <tbb/parallel_for.h>

#include "core/synthesis/alignment.h"
#include "core/synthesis/correction.h"
#include "core/synthesis/pieces.h"

namespace terrazzo {

namespace {

// What a random number is drawn for: keeps the draws of different purposes apart.
enum Purpose : uint64_t { blocks = 1, jitter = 2, correction = 3 };

Size level_size(Size size, int level) {
  const int round_up = (1 << level) - 1;
  return {(size.width + round_up) >> level, (size.height + round_up) >> level};
}

constexpr int draws = 16;  // of a block that must fit

/// The exemplar position from which a block starts.
std::array<int, 2> random_start(const PaddedLevel& exemplar, int side, uint64_t bits) {
  if (exemplar.masked()) {
    const auto [u, v] = exemplar.place(bits);
    return {u - side / 2, v - side / 2};
  }
  const int keep_off = exemplar.wraps() ? 0 : exemplar.keep_off();
  const auto start = [&](uint32_t half, int n) {
    const int room = exemplar.wraps() ? n : std::max(1, n - side - 2 * keep_off);
    return keep_off + int(below(half, uint32_t(room)));
  };
  return {start(uint32_t(bits), exemplar.size().width), start(uint32_t(bits >> 32), exemplar.size().height)};
}

/// Where a mask or controls make some places better than others, the best of several.
std::array<int, 2> best_start(const PaddedLevel& exemplar, const LevelControl* control, Size output, const Rect& block,
                              int side, uint64_t seed) {
  const uint64_t bits = random_bits(seed, Purpose::blocks, block.x / side, block.y / side);
  if (!exemplar.masked() && !control) return random_start(exemplar, side, bits);
  std::array<int, 2> best{};
  uint64_t least = ~uint64_t{0};
  for (int draw = 0; draw < draws; draw++) {
    const std::array<int, 2> start = random_start(exemplar, side, random_bits(bits, draw));
    uint64_t misfit = 0;
    for (int y = 0; y < block.height; y++)
      for (int x = 0; x < block.width; x++) {
        int u = start[0] + x, v = start[1] + y;
        exemplar.settle(u, v);
        const int64_t pixel = int64_t{block.y + y} * output.width + block.x + x;
        if (control) misfit += control->cost(u, v, control->target(pixel));
        misfit += u != start[0] + x || v != start[1] + y;
      }
    if (misfit >= least) continue;
    least = misfit;
    best = start;
  }
  return best;
}

void place_block(Field& field, const Rect& block, std::array<int, 2> start, const PaddedLevel& exemplar) {
  for (int y = 0; y < block.height; y++)
    for (int x = 0; x < block.width; x++) {
      int u = start[0] + x, v = start[1] + y;
      exemplar.settle(u, v);
      field.at(block.x + x, block.y + y) = {uint16_t(u), uint16_t(v)};
    }
}

/// The coarsest level: square blocks of a quarter of the exemplar's side, from random places.
Field random_blocks(Size size, const PaddedLevel& exemplar, const LevelControl* control, const LatticePhase& phase,
                    uint64_t seed) {
  Field field{size, std::vector<ExemplarPixel>(size_t(size.area()))};
  const Size from = exemplar.size();
  const int side = std::max(4, std::min(from.width, from.height) / 4);
  for (int top = 0; top < size.height; top += side)
    for (int left = 0; left < size.width; left += side) {
      const Rect block = intersect(whole(size), {left, top, side, side});
      std::array<int, 2> start = best_start(exemplar, control, size, block, side, seed);
      phase.snap(left, top, start[0], start[1]);
      place_block(field, block, start, exemplar);
    }
  return field;
}

/// Moves a position by up to `amplitude` pixels each way, any number of times around an exemplar that tiles.
void displace(int& u, int& v, const PaddedLevel& exemplar, double amplitude, uint64_t bits) {
  u += int(std::floor(amplitude * (2 * unit_double(bits << 32) - 1) + 0.5));
  v += int(std::floor(amplitude * (2 * unit_double(bits) - 1) + 0.5));
  if (!exemplar.wraps()) return;
  u = wrap(u, exemplar.size().width);
  v = wrap(v, exemplar.size().height);
}

/// Moves every pixel of the coarsest level by up to `amplitude` pixels.
void scatter(Field& field, const PaddedLevel& exemplar, double amplitude, uint64_t seed, int level) {
  if (amplitude <= 0) return;
  for (int y = 0; y < field.size.height; y++)
    for (int x = 0; x < field.size.width; x++) {
      int u = field.at(x, y).x, v = field.at(x, y).y;
      displace(u, v, exemplar, amplitude, random_bits(seed, Purpose::jitter, level, x, y));
      exemplar.settle(u, v);
      field.at(x, y) = {uint16_t(u), uint16_t(v)};
    }
}

/// Each pixel becomes four, which show the four exemplar pixels below it, moved by up to `amplitude` pixels together.
Field upsampled(const Field& parent, Size size, const PaddedLevel& exemplar, const LatticePhase& phase,
                double amplitude, uint64_t seed, int level) {
  Field field{size, std::vector<ExemplarPixel>(size_t(size.area()))};
  tbb::parallel_for(0, size.height, [&](int y) {
    for (int x = 0; x < size.width; x++) {
      const ExemplarPixel p = parent.at(x / 2, y / 2);
      int u = 2 * p.x + (x & 1), v = 2 * p.y + (y & 1);
      if (amplitude > 0) displace(u, v, exemplar, amplitude, random_bits(seed, Purpose::jitter, level, x / 2, y / 2));
      // At the finest level pieces fit one another already; to round each to the lattice would undo that.
      if (level > 0 || amplitude > 0) phase.snap(x, y, u, v);
      exemplar.settle(u, v);
      field.at(x, y) = {uint16_t(u), uint16_t(v)};
    }
  });
  return field;
}

std::vector<ExemplarPixel> similar_pixels(const SimilarSets& sets, Size size) {
  std::vector<ExemplarPixel> out(sets.positions.size());
  for (size_t i = 0; i < out.size(); i++)
    out[i] = {uint16_t(sets.positions[i] % size.width), uint16_t(sets.positions[i] / size.width)};
  return out;
}

/// What a mask lets synthesis use and controls want.
std::vector<double> demand_of(const AppearanceLevel& level, const LevelControl* control) {
  if (control) return control->demand(level.usable);
  return {level.usable.begin(), level.usable.end()};
}

/// Kept pixels have the exemplar's lattice as it is. One that would have to be stretched to wrap around contradicts
/// them; the free pixels then do better without.
Lattice lattice_of(const Appearance& appearance, const SynthesisOptions& options) {
  const Lattice& lattice = appearance.lattice();
  return options.kept.empty() || lattice.fits(options.size, options.tile_x, options.tile_y) ? lattice : Lattice{};
}

struct Effort {
  int passes;
  int random_candidates;
  const Window* window;
};

/// The budget belongs to the coarse levels, where pixels are few and decisions are large. Filling in between kept
/// pixels is harder than going on freely, and there are fewer pixels to do it for.
Effort effort_at(int level, Quality quality, bool between_kept) {
  if (quality == Quality::draft) {
    if (level <= 1) return {between_kept ? 3 : level + 1, 0, &sparse_window()};
    return {5, level >= 3 ? 16 : 4, &full_window()};
  }
  if (between_kept && level <= 1) return {6, 4, &full_window()};
  if (quality == Quality::best) {
    if (level <= 1) return {level == 0 ? 4 : 6, level == 0 ? 0 : 4, &full_window()};
    return {16, level >= 3 ? 24 : 8, &full_window()};
  }
  if (level == 0) return {2, 0, &sparse_window()};
  if (level == 1) return {3, 0, &full_window()};
  return {10, level >= 3 ? 24 : 8, &full_window()};
}

constexpr int alignment_reach = 2;
constexpr double large_piece = 0.2;  // of the exemplar
constexpr double most_coherence = 1.5;
constexpr int finest_limited = 2;

/// The larger a piece has become beyond a fair size, the less it pays to continue it, so that none comes back as a
/// landmark. Finer levels are left out: there pieces no longer grow.
std::vector<uint32_t> piece_coherence(const Field& field, const CorrectionLevel& level, double coherence) {
  if (level.level < finest_limited || level.fixed.any()) return {};
  const Pieces pieces(field, level.exemplar);
  const double fair = large_piece * double(level.exemplar.size().area());
  std::vector<uint32_t> factors(field.pixels.size());
  for (size_t i = 0; i < factors.size(); i++) {
    const double size = std::max(1.0, pieces.area(pieces.of(int(i))) / fair);
    factors[i] = uint32_t(std::min(most_coherence, coherence * size) * unit_factor);
  }
  return factors;
}

}  // namespace

UvMapPtr synthesize(const Index& index, const SynthesisOptions& options, const Task& task) {
  const Appearance& appearance = *index.appearance();
  const int levels = int(appearance.levels().size());
  const Lattice lattice = lattice_of(appearance, options);
  const ControlPyramid controls(options.controls, appearance.size(), options.size, levels, task);
  Field field;
  for (int l = levels - 1; l >= 0; l--) {
    const AppearanceLevel& exemplar_level = appearance.levels()[l];
    const PaddedLevel exemplar(exemplar_level, appearance.wraps());
    const Size size = level_size(options.size, l);
    const size_t order = size_t(levels - 1 - l);
    const double amplitude = order < options.jitter.size() ? options.jitter[order] : 0;
    const LatticePhase phase(lattice, l, options.size, options.tile_x, options.tile_y,
                             {double(options.origin[0]), double(options.origin[1])});
    const FixedPixels fixed(options.kept, options.size, l, exemplar_level.size);
    std::unique_ptr<const LevelControl> control;
    if (!controls.empty()) control = std::make_unique<LevelControl>(controls, l, exemplar);
    field = l == levels - 1 ? random_blocks(size, exemplar, control.get(), phase, options.seed)
                            : upsampled(field, size, exemplar, phase, amplitude, options.seed, l);
    if (l == levels - 1) scatter(field, exemplar, amplitude, options.seed, l);
    fixed.apply(field);
    const std::vector<ExemplarPixel> similar = similar_pixels(index.levels()[l], exemplar_level.size);
    const CorrectionLevel level{
        exemplar, similar, index.levels()[l].per_pixel, l, options.tile_x, options.tile_y, phase, fixed, control.get()};
    Occupancy occupancy(exemplar_level.size, l >= 1 ? options.evenness : 0, demand_of(exemplar_level, control.get()));
    const Effort effort = effort_at(l, options.quality, fixed.any());
    const bool regular = lattice.rank > 0;
    if (phase.active() && l < levels - 1) align_pieces(field, level, alignment_reach, task);
    for (int pass = 0; pass < effort.passes; pass++) {
      CorrectionPass how{.window = effort.window,
                         .coherence = uint32_t(std::floor(options.coherence * unit_factor)),
                         .random_candidates = effort.random_candidates,
                         .seed = random_bits(options.seed, Purpose::correction),
                         .pass = pass};
      if (!regular) how.piece_coherence = piece_coherence(field, level, options.coherence);
      correct(field, level, how, occupancy, task);
      task.progress(std::pow(0.25, l) * (pass + 1) / effort.passes);
    }
  }
  return UvMap::make(options.size, appearance.size(), std::move(field.pixels),
                     {options.tile_x, options.tile_y, appearance.wraps()});
}

}  // namespace terrazzo
