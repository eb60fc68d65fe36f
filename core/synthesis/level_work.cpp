#include "core/synthesis/level_work.h"

#include <algorithm>
#include <cmath>

#include "core/image/image_ops.h"
#include "core/synthesis/state/comparison_window.h"
#include "core/synthesis/state/piece_limits.h"
#include "core/synthesis/state/usage_penalty.h"
#include "core/synthesis/steps/alignment.h"
#include "core/synthesis/steps/coherence_repair.h"
#include "core/synthesis/steps/course_layout.h"
#include "core/synthesis/steps/graphcut_repair.h"
#include "core/synthesis/steps/initialize.h"
#include "core/synthesis/steps/piece_relocation.h"

namespace terrazzo {

namespace {

Size level_size(Size size, int level) {
  const int round_up = (1 << level) - 1;
  return {(size.width + round_up) >> level, (size.height + round_up) >> level};
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

/// The exemplar's lattice, made to wrap around with the result. Kept pixels have it as it is: it bends where none are
/// kept or, where they leave no room and it does not fit, is cut where the result wraps.
LatticeSurface surface_of(const Lattice& lattice, const SynthesisOptions& options, const LatticeGaps& gaps) {
  const bool fits = options.kept.empty() || lattice.fits(options.size, options.tile_x, options.tile_y);
  return {options.size,
          options.tile_x && (fits || gaps.x.length > 0),
          options.tile_y && (fits || gaps.y.length > 0),
          {double(options.origin[0]), double(options.origin[1])},
          gaps};
}

int reach_of(int passes) {
  return passes * sub_passes * correction_reach;
}

constexpr int alignment_reach = 2;
// Seams move from the finest level on which pieces still change as wholes down to the one that sees joints best.
constexpr int seam_level = 1;
// At the finest level seams only look for the pixel at which joints meet; before that they look for joints, half a
// brick away. Courses do not tell how long bricks are.
constexpr SeamMoves to_the_pixel{.reach = 4, .stay = 32};
// Around whole bricks they look for joints that bricks were cut beside. The more clearly those are told, the less far:
// boards would keep stubs of joints.
constexpr int around_bricks = 8, around_clear_bricks = 2;
constexpr double stay_around_bricks = 1;
constexpr SeamMoves along_courses{.reach = 20, .stay = 8};
constexpr int nearest_joint = 10, farthest_joint = 24;
constexpr double shortest_brick = 64;  // pixels; what is shorter is laid well enough as it is
constexpr double stay_by_joint = 4;    // where the joint is as near as that, less where it is farther
constexpr int coarsest_mended = 3;     // at coarser ones it brings nothing
constexpr int finest_mended = 2;       // nor at finer ones, but on lattices and beside kept pixels
constexpr int passes_after_mending[] = {2, 5};
constexpr int coarsest_reworked = 3;  // coarser windows are all unlike one another

// Between kept pixels nothing is said about whole pieces; single ones hold together more instead.
constexpr double coherence_between_kept = 0.75;
// Nor where a target says what goes where: limited pieces fall apart into ever the same scrap that misses nothing of
// it.
constexpr double coherence_where_steered = 0.85;
constexpr int finest_limited = 2;  // at finer levels pieces hardly grow
// Rare features are won or lost at the coarsest levels. There pieces hold together more, and what is used too little
// is made much cheaper; finer levels would break features for it.
constexpr int landmark_levels = 2;
constexpr double landmark_coherence = 0.7;
constexpr double least_landmark_factor = 0.5;
constexpr double least_occupancy_factor = 0.75;
constexpr int finest_even = 1;       // evenness has no say below this level,
constexpr int finest_recounted = 2;  // and below this one it goes by what the level began with

}  // namespace

Plane SharedWork::plane(int level) const {
  return {level_size(options.size, level), options.tile_x, options.tile_y};
}

double SharedWork::jitter(int level) const {
  const size_t order = size_t(levels - 1 - level);  // counted from the coarsest
  return order < options.jitter.size() ? options.jitter[order] : 0;
}

bool SharedWork::places_landmarks(int level) const {
  return levels - 1 - level < landmark_levels;
}

struct LevelWork::Effort {
  int passes;
  int random_candidates;
  const Window* window;
  int places_tried = 6;  // where windows are unlike the exemplar
};

/// The budget belongs to the coarse levels, where pixels are few and decisions are large. Filling in between kept
/// pixels is harder than going on freely, and there are fewer pixels to do it for.
LevelWork::Effort LevelWork::effort_at(int level, Quality quality, bool between_kept, bool coarsest) {
  if (quality == Quality::draft) {
    if (level <= 1) return {between_kept ? 3 : level + 1, 0, &sparse_window()};
    return {5, level >= 3 ? 16 : 4, &full_window()};
  }
  if (between_kept && level <= 1) return {6, 4, &full_window()};
  if (quality == Quality::best) {
    if (level <= 1) return {level == 0 ? 4 : 6, level == 0 ? 0 : 4, &full_window(), 16};
    return {16, level >= 3 ? 24 : 8, &full_window(), 16};
  }
  if (level == 0) return {coarsest ? 2 : 1, 0, &sparse_window()};  // a tiny exemplar has no other level
  if (level == 1) return {2, 0, &full_window()};
  return {between_kept ? 10 : 7, level >= 3 ? 24 : 8, &full_window()};
}

LevelWork::LevelWork(const SharedWork& shared, int level)
    : shared_(shared),
      level_(level),
      exemplar_(shared.exemplar(level), shared.index.appearance()->wraps()),
      phase_(shared.index.appearance()->repeats(), shared.exemplar(level).size, level,
             surface_of(shared.lattice, shared.options, shared.gaps)),
      fixed_(shared.fixed(level)),
      control_(shared.controls.empty() ? nullptr : std::make_unique<LevelControl>(shared.controls, level, exemplar_)),
      usage_(shared.exemplar(level).size, level >= finest_even ? shared.options.evenness : 0,
             shared.places_landmarks(level) ? least_landmark_factor : least_occupancy_factor,
             demand_of(shared.exemplar(level), control_.get())) {
  if (insists_on_evenness()) usage_.insist();
  if (looks_around()) usage_.look_around(shared.plane(level));
}

Field LevelWork::beginning() const {
  const uint64_t seed = shared_.options.seed;
  Field field = random_blocks(shared_.plane(level_), exemplar_, control_.get(), phase_, seed);
  scatter(field, exemplar_, shared_.jitter(level_), seed, level_);
  fixed_.begin(field, PlaneWindow::all_of(shared_.plane(level_)));
  return field;
}

Field LevelWork::starts(const Field& parent, const PlaneWindow& window) {
  Field starts = block_starts(parent, window, exemplar_, phase_, shared_.jitter(level_), shared_.options.seed, level_);
  const FixedPixels fixed = shared_.fixed(level_ + 1);
  if (fixed.any()) start_where_fixed(starts, fixed, window);
  if (refills()) find_similar();
  const CorrectionLevel level = correction_level(window, similar_, fixed);
  if (refills()) {
    usage_.recount(starts, fixed);
    relocate_pieces(starts, 2, level, usage_, random_bits(shared_.options.seed, Purpose::piece_relocation),
                    shared_.task);
  }
  if (phase_.resolves_cells()) align_pieces(starts, 2, level, alignment_reach, shared_.task);
  if (lays_bricks())
    if (const std::optional<SeamMoves> moves = lay(starts, level)) {
      move_seams(starts, level, *moves, shared_.task);
      return starts;
    }
  if (moves_seams()) move_seams(starts, level, to_joints(), shared_.task);
  return starts;
}

void LevelWork::count_use(std::span<const ExemplarPixel> starts) {
  if (level_ < finest_recounted) usage_.count_for_good(starts, shared_.fixed(level_ + 1));
}

Field LevelWork::begun(std::span<const ExemplarPixel> starts, const PlaneWindow& from,
                       const PlaneWindow& window) const {
  Field field = expanded(starts, from, window, exemplar_);
  fixed_.apply(field, window);
  return field;
}

void LevelWork::correct(Field& field, const PlaneWindow& window, const Rect& wanted) {
  find_similar();
  const CorrectionLevel level = correction_level(window, similar_, fixed_);
  const Effort effort = this->effort();
  for (int pass = 0; pass < effort.passes; pass++) {
    CorrectionPass how{.window = effort.window,
                       .coherence = uint32_t(std::floor(coherence() * unit_factor)),
                       .random_candidates = effort.random_candidates,
                       .seed = random_bits(shared_.options.seed, Purpose::correction),
                       .pass = pass,
                       .wanted = grown(wanted, reach_of(effort.passes - 1 - pass))};
    if (mends(effort.passes - pass))
      repair_seams(field, level, usage_, random_bits(shared_.options.seed, Purpose::graphcut_repair), shared_.task);
    if (limits_pieces()) how.piece_coherence = piece_coherence(field, level, coherence(), PieceLimits::of(regular()));
    terrazzo::correct(field, level, how, usage_, shared_.task);
    shared_.task.progress(std::pow(0.25, level_ - shared_.finest) * (pass + 1) / effort.passes);
  }
  if (reworks())
    repair_incoherent(field, level, usage_, effort.places_tried,
                      random_bits(shared_.options.seed, Purpose::coherence_repair), shared_.task);
}

LevelWork::Effort LevelWork::effort() const {
  return effort_at(level_, shared_.options.quality, fixed_.any(), level_ == shared_.levels - 1);
}

int LevelWork::reach() const {
  return reach_of(effort().passes);
}

bool LevelWork::limits_pieces() const {
  return level_ >= finest_limited && !fixed_.any() && !control_;
}

double LevelWork::coherence() const {
  const double full = shared_.options.coherence;
  if (fixed_.any()) return full * coherence_between_kept;
  if (control_) return full * coherence_where_steered;
  return limits_pieces() && shared_.places_landmarks(level_) ? full * landmark_coherence : full;
}

bool LevelWork::moves_seams() const {
  return level_ <= seam_level && (regular() || fixed_.any()) && shared_.options.quality != Quality::draft;
}

bool LevelWork::refills() const {
  return level_ == seam_level && moves_seams() && regular() && !control_;
}

bool LevelWork::lays_bricks() const {
  return shared_.options.whole_bricks && level_ < seam_level && moves_seams() && regular() && !control_ &&
         !fixed_.any() && shared_.index.appearance()->repeats().parts.empty() &&
         (shared_.lattice.rank == 1 || shared_.lattice.longest_step() >= shortest_brick);
}

std::optional<SeamMoves> LevelWork::lay(Field& starts, const CorrectionLevel& level) const {
  const Appearance& appearance = *shared_.index.appearance();
  const Coursing coursing = find_coursing(appearance, shared_.task);
  const LatticePhase phase(shared_.lattice, 0, surface_of(shared_.lattice, shared_.options, shared_.gaps));
  if (!lay_courses(starts, 2, level, appearance, coursing, phase, shared_.task)) return std::nullopt;
  const int clear = std::min(around_bricks, around_clear_bricks + (coursing.half_joint << coursing.level));
  return SeamMoves{.reach = coursing.is_clear() ? clear : around_bricks, .stay = stay_around_bricks, .block = 2};
}

SeamMoves LevelWork::to_joints() const {
  SeamMoves moves = level_ < seam_level ? to_the_pixel : along_courses;
  if (level_ == seam_level && shared_.lattice.rank > 1) {
    const double half = shared_.lattice.longest_step() / 2 / double(int64_t{2} << level_);
    moves.reach = std::clamp(int(half), nearest_joint, farthest_joint);
    moves.stay = stay_by_joint * nearest_joint / moves.reach;
  }
  moves.block = 2;
  moves.fair_piece = PieceLimits::of(true).large * double(exemplar_.size().area()) / 4;
  return moves;
}

bool LevelWork::mends(int passes_left) const {
  if (shared_.options.quality == Quality::draft) return false;
  return level_ >= (regular() || fixed_.any() ? finest_whole_level : finest_mended) && level_ <= coarsest_mended &&
         !control_ && std::ranges::count(passes_after_mending, passes_left) > 0;
}

bool LevelWork::reworks() const {
  return level_ >= finest_whole_level && level_ <= coarsest_reworked && !regular() && !control_ &&
         shared_.options.quality != Quality::draft;
}

void LevelWork::find_similar() {
  if (similar_.empty()) similar_ = similar_pixels(shared_.index.levels()[level_], shared_.exemplar(level_).size);
}

bool LevelWork::insists_on_evenness() const {
  return shared_.places_landmarks(level_) && !regular() && !control_ && !fixed_.any();
}

CorrectionLevel LevelWork::correction_level(const PlaneWindow& window, const std::vector<ExemplarPixel>& similar,
                                            const FixedPixels& fixed) const {
  return {exemplar_, similar, shared_.index.levels()[level_].per_pixel, level_, window, phase_, fixed, control_.get()};
}

void LevelWork::start_where_fixed(Field& starts, const FixedPixels& fixed, const PlaneWindow& window) const {
  const int width = shared_.plane(level_).size.width;
  for (int row = 0; row < starts.size.height; row++)
    for (int column = 0; column < starts.size.width; column++)
      if (fixed.at(window.index(column, row)))
        starts.at(column, row) = fixed_.shown(size_t(2 * window.y(row)) * width + 2 * window.x(column));
}

}  // namespace terrazzo
