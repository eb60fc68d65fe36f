#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/exemplar/appearance.h"
#include "core/exemplar/element_courses.h"
#include "core/synthesis/state/comparison_window.h"
#include "core/synthesis/state/control.h"
#include "core/synthesis/state/purpose.h"
#include "core/synthesis/state/usage_penalty.h"
#include "core/synthesis/steps/seams.h"
#include "core/synthesis/synthesis_options.h"

/// The synthesis as a list. Every ingredient is a step: a value that says when in the work on a level it runs, where it
/// applies and what it does. steps.cpp holds the one table of them, in the order in which they run. To add one,
/// write it as a file in steps/, give it a row there, raise synthesis_version, and record tests/golden again; tests ask
/// for its name in examples/guide/how-synthesis-works.md and for its section in tests/bench/experiments.md.
///
/// A step leaves fixed pixels as they are, shows only usable exemplar pixels (PaddedLevel::holds), and stays in phase,
/// in elements and within the controls where CorrectionLevel has such.
///
/// The finest level may be worked out in parts: its field is then `level.window` of the plane, of which only
/// `StepContext::wanted` has to be right in the end. reach_of() counts what the correction passes read beyond that;
/// another step before or after a pass of that level must add what it reads.
namespace terrazzo {

/// Covers all node types that share the pipeline; part of their versions. Raise it whenever a step changes results.
inline constexpr int synthesis_version = 40;

/// The finest level that is worked out for the plane as a whole. Of finer ones only the blocks that they start from
/// are: there bricks and elements are laid, and seams moved for the last time.
inline constexpr int finest_whole_level = 1;

/// The size of a level of the output.
Size level_size(Size output, int level);

/// When in the work on a level a step runs.
enum class Phase : uint8_t {
  costs,        ///< before all else: sets up what counts in the corrections besides how well a candidate fits
  coarsest,     ///< once, to fill the coarsest level
  upsampling,   ///< once per finer level, on blocks of 2x2 pixels that still move as wholes
  before_pass,  ///< before each pass of correction
  pass,         ///< the pass itself
};
inline constexpr std::string_view phase_names[] = {"costs", "coarsest level", "upsampling", "before pass", "pass"};

/// How the exemplar's elements become whole in the result, if that is asked for and it has enough of them.
enum class WholeElements : uint8_t {
  none,       ///< they do not, or as parts of its courses
  laid,       ///< they are laid side by side, their rims bent to meet
  heaped,     ///< they are laid as they are, and seams look for their outlines, which are not sure
  completed,  ///< they are completed where its lattice has them
};

/// What decides which steps run on a level, computed once for it.
struct LevelFacts {
  int level = 0;   ///< 0 = finest
  int levels = 1;  ///< of the exemplar's pyramid
  Quality quality = Quality::normal;
  bool regular = false;  ///< the exemplar has a lattice
  bool kept = false;     ///< some of the output's pixels are given (SynthesisOptions::kept)
  bool steered = false;  ///< controls say what goes where
  bool bands = false;    ///< the exemplar's courses are laid anew
  WholeElements elements = WholeElements::none;

  bool coarsest() const { return level == levels - 1; }
  /// Rare features are won or lost at the coarsest levels.
  bool is_among_coarsest() const;
  /// Whether few levels follow on those where rare features are won or lost: exemplars under 128 pixels.
  bool small() const;
  /// Whether how evenly the exemplar is used counts on this level.
  bool counts_use() const;
  /// Whether elements become whole on this level. Those that are laid stay what they are.
  bool makes_elements_whole() const;
  bool lays_elements() const { return makes_elements_whole() && elements != WholeElements::completed; }
  bool heaps_elements() const { return makes_elements_whole() && elements == WholeElements::heaped; }
};

/// How much work goes into a level.
struct Effort {
  int passes = 1;                  ///< of correction
  int random_candidates = 0;       ///< per pixel and pass
  const Window* window = nullptr;  ///< the pixels that are compared
};

/// The budget belongs to the coarse levels, where pixels are few and decisions are large. Filling in between kept
/// pixels is harder than going on freely, and there are fewer pixels to do it for.
Effort effort_of(const LevelFacts& facts);

/// How many pixels beyond what is wanted so many correction passes read.
int reach_of(int passes);

/// How an exemplar repeats in a result: courses that come once each along them only, where they are laid anew, and not
/// at all where controls say what goes where.
Repeats repeats_in_result(const Appearance& appearance, const SynthesisOptions& options);
/// Whether the exemplar's courses are laid anew.
bool lays_courses(const Appearance& appearance, const SynthesisOptions& options);
/// Whether a result that wraps shows them without bending them more than can be seen.
bool repeats_fit(const Appearance& appearance, const SynthesisOptions& options);

/// What all levels of a synthesis share. What it is made from must outlive it. Thread-safe to read.
struct SharedWork {
  SharedWork(const Index& index, const SynthesisOptions& options, const Task& task);

  const AppearanceLevel& exemplar(int level) const { return index.appearance()->levels()[level]; }
  Plane plane(int level) const;
  double jitter(int level) const;
  FixedPixels fixed(int level) const { return {options.kept, options.size, level, exemplar(level).size}; }
  /// What the exemplar's lattice covers, made to wrap around with the result.
  LatticeSurface surface() const;
  LevelFacts facts(int level) const;

  const Index& index;
  const SynthesisOptions& options;
  const Task& task;
  int levels;
  ElementCourses courses;        ///< of the exemplar, if they are laid anew
  Repeats repeats;               ///< of the exemplar, as far as they count in the result
  Lattice lattice;               ///< theirs
  std::vector<ShownSpan> bands;  ///< those courses, as the result shows them
  LatticeGaps gaps;              ///< between kept pixels
  Vector2d origin;               ///< where the lattice starts in the result
  ControlPyramid controls;
  WholeElements elements;
  int finest = 0;  ///< the level that ends the work, for progress
};

/// What a step works on. Borrows everything; used by one thread.
struct StepContext {
  const SharedWork& shared;
  const LevelFacts& facts;
  const Effort& effort;
  const CorrectionLevel& level;  ///< see CorrectionLevel::block
  const FixedPixels& fixed;      ///< of the level's own pixels, also while upsampling
  UsagePenalty& usage;
  Field& field;
  const Field* parent = nullptr;            ///< while upsampling: the next coarser level
  int pass = 0;                             ///< of effort.passes
  Rect wanted{};                            ///< the columns and rows that have to be right in the end
  std::optional<SeamMoves> seams{};         ///< how seams move on this level, if a step before has decided it
  std::vector<uint32_t> piece_coherence{};  ///< for this pass, see CorrectionPass
  Task task{};  ///< of the running step, whose progress runs from 0 to 1; never report to `shared.task`

  /// Random bits, the same on every level and in every pass: steps extend them by those and by the place.
  uint64_t bits(Purpose purpose) const;
};

struct Step {
  std::string_view name;  ///< of its file in steps/ or state/
  Phase phase;
  std::string_view purpose;  ///< one line
  bool (*applies)(const LevelFacts&);
  void (*run)(StepContext&);
};

/// All steps, in the order in which they run.
std::span<const Step> synthesis_steps();

/// Called by benchmarks and tests with what has run, what it has left behind, and how many CPU seconds of all threads
/// it took.
using StepWatcher = std::function<void(const Step&, const StepContext&, double)>;
/// From now on every step that has run is told to `watch`, on the thread that ran it. Not thread-safe: call it before
/// anything is synthesized.
void watch_steps(StepWatcher watch);

/// Runs the steps of a phase that apply, and calls `after_each`, if given, after each of them.
void run_steps(Phase phase, StepContext& context, const std::function<void()>& after_each = {});

}  // namespace terrazzo
