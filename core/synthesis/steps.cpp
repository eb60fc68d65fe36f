#include "core/synthesis/steps.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

#include "core/base/hash.h"
#include "core/base/tuning.h"
#include "core/synthesis/state/piece_limits.h"
#include "core/synthesis/steps/band_layout.h"
#include "core/synthesis/steps/correction.h"
#include "core/synthesis/steps/element_cores.h"
#include "core/synthesis/steps/element_layout.h"
#include "core/synthesis/steps/graphcut_repair.h"
#include "core/synthesis/steps/initialize.h"

namespace terrazzo {

namespace {

/// At which levels steps run, and how strongly.
struct StepTuning {
  double coherence_between_kept = 0.75;
  double coherence_where_steered = 0.85;
  double landmark_coherence = 0.7;
  double stay_to_joints = 8;
  double stay_to_the_pixel = 32;
  double stay_around_bands = 1;
  int landmark_levels = 2;
  int most_levels_of_small = 3;
  int finest_even = 1;
  int coarsest_repaired = 3;
  int first_repair = 5;
  int last_repair = 2;
  int seam_reach_to_joints = 20;
  int seam_reach_to_the_pixel = 4;
  int seam_reach_around_bands = 2;
  int left_out = 0;
};
const Tunable<StepTuning> step_tuning(
    "steps",
    {
        {&StepTuning::coherence_between_kept, "coherence_between_kept", "factor",
         "lower: pixels between kept ones hold together more, as their pieces are not limited; higher: more variety",
         "piece_limits", 0, 100},
        {&StepTuning::coherence_where_steered, "coherence_where_steered", "factor",
         "lower: larger pieces under controls; higher: the target is followed more closely", "piece_limits", 0, 100},
        {&StepTuning::landmark_coherence, "landmark_coherence", "factor",
         "lower: rare features stay whole at the coarsest levels; higher: more variety", "What each rule decides", 0,
         100},
        {&StepTuning::stay_to_joints, "stay_to_joints", "appearance units per pixel",
         "higher: seams stay nearer; lower: they go half a brick for a joint", "seams", 0, 10000},
        {&StepTuning::stay_to_the_pixel, "stay_to_the_pixel", "appearance units per pixel",
         "higher: seams stay; lower: they wander at the finest level", "seams", 0, 10000},
        {&StepTuning::stay_around_bands, "stay_around_bands", "appearance units per pixel",
         "lower: seams find the joints that bricks were cut beside; higher: they keep to the cut",
         "What each rule decides", 0, 10000},
        {&StepTuning::landmark_levels, "landmark_levels", "levels",
         "more: rare features are placed evenly; fewer: fewer of them are broken for it", "usage_penalty"},
        {&StepTuning::most_levels_of_small, "most_levels_of_small", "levels",
         "of exemplars whose use is evened out less; 3 are those under 128 pixels. Higher: fewer crumbs, more repeats",
         "small_exemplars"},
        {&StepTuning::finest_even, "finest_even", "level",
         "lower: evenness counts at finer levels too, and breaks features", "What each rule decides"},
        {&StepTuning::coarsest_repaired, "coarsest_repaired", "level",
         "higher: coarser levels too, where it brings nothing", "What each rule decides"},
        {&StepTuning::first_repair, "first_repair", "passes left", "higher: seams are repaired earlier",
         "What each rule decides"},
        {&StepTuning::last_repair, "last_repair", "passes left", "lower: fewer passes smooth what was repaired last",
         "What each rule decides"},
        {&StepTuning::seam_reach_to_joints, "seam_reach_to_joints", "pixels",
         "higher: joints of longer bricks are found; costs time", "seams", 0, 1000},
        {&StepTuning::seam_reach_to_the_pixel, "seam_reach_to_the_pixel", "pixels",
         "higher: the finest level looks for other joints, not for where two meet; costs time", "seams", 0, 1000},
        {&StepTuning::seam_reach_around_bands, "seam_reach_around_bands", "pixels",
         "higher: seams find joints that were missed; lower: boards keep no stubs of joints", "band_layout", 0, 1000},
        {&StepTuning::left_out, "left_out", "row of the table of steps, from 1",
         "this one does not run, to see what it brings and costs; 0: all run", "What each step brings"},
    });

bool is_draft(const LevelFacts& f) {
  return f.quality == Quality::draft;
}

// Where steps apply.

bool always(const LevelFacts&) {
  return true;
}

/// Measured on lattices this breaks more and makes nothing more like the exemplar.
bool controls_use(const LevelFacts& f) {
  return f.is_among_coarsest() && f.level > finest_whole_level && !f.regular && !f.steered && !f.kept;
}

/// On lattices everything near by is alike, and controls say what belongs where.
bool penalizes_proximity(const LevelFacts& f) {
  return !f.regular && !f.steered;
}

/// Seams between courses or tiles show more than others, and so do those along an outline that was drawn. Measured on
/// other exemplars moving seams brings nothing. Between elements whose rims meet there is nothing to move.
bool moves_seams(const LevelFacts& f) {
  if (f.lays_elements()) return f.heaps_elements();
  return f.level <= finest_whole_level && (f.regular || f.kept) && !is_draft(f);
}

bool keeps_pixels(const LevelFacts& f) {
  return f.kept;
}

/// Where only seams still move, before they look for the pixel.
bool lays_bands(const LevelFacts& f) {
  return f.bands && f.level < finest_whole_level;
}

bool repairs_seams(const LevelFacts& f) {
  const int finest = f.kept ? finest_whole_level : finest_whole_level + 1;
  return !is_draft(f) && f.level >= finest && f.level <= step_tuning->coarsest_repaired && !f.steered;
}

/// Between kept pixels nothing is said about whole pieces; single ones hold together more instead. Nor where a target
/// says what goes where: limited pieces fall apart into ever the same scrap that misses nothing of it.
bool limits_pieces(const LevelFacts& f) {
  return f.level > finest_whole_level && !f.kept && !f.steered;
}

// What they do.

void control_use(StepContext& c) {
  c.usage.enable_integral_control();
}

void penalize_proximity(StepContext& c) {
  c.usage.enable_proximity_penalty(c.shared.plane(c.facts.level));
}

void place_blocks(StepContext& c) {
  c.field = random_blocks(c.level, c.shared.options.seed);
}

void jitter_coarsest(StepContext& c) {
  scatter(c.field, c.level, c.shared.jitter(c.facts.level), c.shared.options.seed);
}

void begin_with_kept(StepContext& c) {
  c.level.fixed.begin(c.field, c.level.window);
}

void upsample(StepContext& c) {
  c.field = block_starts(*c.parent, c.level, c.shared.jitter(c.facts.level), c.shared.options.seed);
}

/// `c.level.fixed` is of the parents; what each block shows is told by the first of its pixels on this level.
void start_where_kept(StepContext& c) {
  const CorrectionLevel& level = c.level;
  const size_t width = size_t(c.shared.plane(c.facts.level).size.width);
  for (int row = 0; row < c.field.size.height; row++)
    for (int column = 0; column < c.field.size.width; column++)
      if (level.is_fixed(column, row))
        c.field.at(column, row) = c.fixed.shown(2 * size_t(level.window.y(row)) * width + 2 * level.window.x(column));
}

void lay_courses(StepContext& c) {
  lay_bands(c.field, c.level, *c.shared.index.appearance(), c.shared.courses, c.shared.bands, c.bits(Purpose::courses),
            c.task);
  c.seams =
      SeamMoves{.reach = step_tuning->seam_reach_around_bands, .distance_penalty = step_tuning->stay_around_bands};
}

void lay_whole_elements(StepContext& c) {
  const ElementRims rims = c.facts.heaps_elements() ? ElementRims::as_they_are : ElementRims::bent;
  lay_elements(c.field, c.level, *c.shared.index.appearance(), rims, c.task);
}

void complete(StepContext& c) {
  complete_elements(c.field, c.level, *c.shared.index.appearance());
}

/// At the finest level seams only look for the pixel at which joints meet; before that they look for joints, half a
/// brick away, as do those between stones of a heap, which are laid last. Without a lattice, between kept pixels, the
/// limit on pieces is that with one; whole stones have none.
SeamMoves seams_to_joints(const StepContext& c) {
  const StepTuning& t = *step_tuning;
  SeamMoves moves{.reach = t.seam_reach_to_joints, .distance_penalty = t.stay_to_joints};
  if (c.facts.heaps_elements()) return moves;
  if (c.facts.level < finest_whole_level)
    moves = {.reach = t.seam_reach_to_the_pixel, .distance_penalty = t.stay_to_the_pixel};
  const double blocks = double(c.level.exemplar.size().area()) / (c.level.block * c.level.block);
  moves.target_area = PieceLimits::of(true).large * blocks;
  return moves;
}

void move_to_joints(StepContext& c) {
  move_seams(c.field, c.level, c.seams ? *c.seams : seams_to_joints(c), c.task);
}

void repair(StepContext& c) {
  const int left = c.effort.passes - c.pass;
  // Without a lattice the second time breaks more than it mends.
  if (left == step_tuning->first_repair || (left == step_tuning->last_repair && (c.facts.regular || c.facts.kept)))
    repair_seams(c.field, c.level, c.usage, c.bits(Purpose::graphcut_repair), c.task);
}

/// The factor on continuing a neighbour's piece.
double coherence(const StepContext& c) {
  const LevelFacts& f = c.facts;
  const double asked = c.shared.options.coherence;
  if (f.kept) return asked * step_tuning->coherence_between_kept;
  if (f.steered) return asked * step_tuning->coherence_where_steered;
  return limits_pieces(f) && f.is_among_coarsest() ? asked * step_tuning->landmark_coherence : asked;
}

void limit_pieces(StepContext& c) {
  c.piece_coherence = piece_coherence(c.field, c.level, coherence(c), PieceLimits::of(c.facts.regular));
}

void correct_pixels(StepContext& c) {
  CorrectionPass pass{.window = c.effort.window,
                      .coherence = uint32_t(std::floor(coherence(c) * unit_factor)),
                      .piece_coherence = std::move(c.piece_coherence),
                      .random_candidates = c.effort.random_candidates,
                      .seed = c.bits(Purpose::correction),
                      .pass = c.pass,
                      .wanted = grown(c.wanted, reach_of(c.effort.passes - 1 - c.pass))};
  correct(c.field, c.level, pass, c.usage, c.task);
}

StepWatcher watcher;  // see watch_steps()

const Step all_steps[] = {
    {"usage_penalty", Phase::costs, "over-used parts of the exemplar cost more and more", controls_use, control_use},
    {"proximity_penalty", Phase::costs, "parts that already appear nearby cost more", penalizes_proximity,
     penalize_proximity},
    {"initialize", Phase::coarsest, "random blocks of the exemplar", always, place_blocks},
    {"jitter", Phase::coarsest, "pixels move at random", always, jitter_coarsest},
    {"fixed_pixels", Phase::coarsest, "kept pixels get their old content back", keeps_pixels, begin_with_kept},
    {"initialize", Phase::upsampling, "each pixel becomes four, with jitter and in phase with the lattice", always,
     upsample},
    {"fixed_pixels", Phase::upsampling, "kept pixels get their old content back", keeps_pixels, start_where_kept},
    {"band_layout", Phase::upsampling, "courses of bricks, boards and panels are laid anew", lays_bands, lay_courses},
    {"element_layout", Phase::upsampling, "stones are laid as wholes",
     [](const LevelFacts& f) { return f.lays_elements(); }, lay_whole_elements},
    {"element_cores", Phase::upsampling, "tiles and bricks become whole where they lie",
     [](const LevelFacts& f) { return f.makes_elements_whole() && !f.lays_elements(); }, complete},
    {"seams", Phase::upsampling, "seams between pieces move to joints", moves_seams, move_to_joints},
    {"graphcut_repair", Phase::before_pass, "the worst seams are covered with patches along minimum cuts",
     repairs_seams, repair},
    {"piece_limits", Phase::before_pass, "pieces that are too large or too small cost more to continue", limits_pieces,
     limit_pieces},
    {"correction", Phase::pass, "every pixel takes the best of its coherent and k-coherent candidates", always,
     correct_pixels},
};

}  // namespace

bool LevelFacts::is_among_coarsest() const {
  return levels - 1 - level < step_tuning->landmark_levels;
}

bool LevelFacts::small() const {
  return levels <= step_tuning->most_levels_of_small;
}

/// Of small exemplars the level after the coarsest is among the last: what breaks there for an even use stays broken.
bool LevelFacts::counts_use() const {
  return level >= step_tuning->finest_even && (!small() || level != levels - 2);
}

/// Like courses, where only seams still move. Controls say what goes where.
bool LevelFacts::makes_elements_whole() const {
  return elements != WholeElements::none && level < finest_whole_level && quality != Quality::draft && !steered;
}

void watch_steps(StepWatcher watch) {
  watcher = std::move(watch);
}

uint64_t StepContext::bits(Purpose purpose) const {
  return random_bits(shared.options.seed, purpose);
}

std::span<const Step> synthesis_steps() {
  return all_steps;
}

void run_steps(Phase phase, StepContext& context, const std::function<void()>& after_each) {
  for (const Step& step : all_steps) {
    if (step.phase != phase || !step.applies(context.facts) || &step - all_steps + 1 == step_tuning->left_out) continue;
    const std::clock_t start = std::clock();
    step.run(context);
    if (watcher) watcher(step, context, double(std::clock() - start) / CLOCKS_PER_SEC);
    if (after_each) after_each();
  }
}

}  // namespace terrazzo
