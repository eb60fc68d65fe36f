#include "core/synthesis/level_work.h"

#include <algorithm>
#include <cmath>

#include "core/base/tuning.h"
#include "core/synthesis/steps/initialize.h"

namespace terrazzo {

namespace {

/// How evenly the exemplar is used.
struct LevelWorkTuning {
  double least_landmark_factor = 0.5;
  double least_factor = 0.75;
};
const Tunable<LevelWorkTuning> level_work_tuning(
    "level_work", {
                      {&LevelWorkTuning::least_landmark_factor, "least_landmark_factor", "factor",
                       "lower: what is used too little is cheaper at the coarsest levels, and wins; finer levels break "
                       "features for it. Not for exemplars under 128 pixels (small_exemplars)",
                       "What each rule decides", 0, 1},
                      {&LevelWorkTuning::least_factor, "least_factor", "factor", "the same at the other levels",
                       "What each rule decides", 0, 1},
                  });

/// What a mask lets synthesis use and controls want.
std::vector<double> demand_of(const AppearanceLevel& level, const LevelControl* control) {
  if (control) return control->demand(level.usable);
  return {level.usable.begin(), level.usable.end()};
}

/// As how many steps one of the phase counts in progress.
int counts_of(Phase phase) {
  constexpr int correction = 3;
  return phase == Phase::pass ? correction : 1;
}

std::vector<ExemplarPixel> unpacked(const SimilarSets& sets, Size size) {
  std::vector<ExemplarPixel> out(sets.positions.size());
  for (size_t i = 0; i < out.size(); i++)
    out[i] = {uint16_t(sets.positions[i] % size.width), uint16_t(sets.positions[i] / size.width)};
  return out;
}

}  // namespace

LevelWork::LevelWork(const SharedWork& shared, int level)
    : shared_(shared),
      facts_(shared.facts(level)),
      effort_(effort_of(facts_)),
      exemplar_(shared.exemplar(level), shared.index.appearance()->wraps()),
      phase_(shared.repeats, shared.exemplar(level).size, level, shared.surface()),
      fixed_(shared.fixed(level)),
      control_(facts_.steered ? std::make_unique<LevelControl>(shared.controls, level, exemplar_) : nullptr),
      usage_(shared.exemplar(level).size, facts_.counts_use() ? shared.options.evenness : 0,
             facts_.is_among_coarsest() && !facts_.small() ? level_work_tuning->least_landmark_factor
                                                           : level_work_tuning->least_factor,
             demand_of(shared.exemplar(level), control_.get())) {
  Field none;
  const CorrectionLevel whole = correction_level(PlaneWindow::all_of(shared_.plane(level)), fixed_);
  StepContext c = context(whole, none);
  run_steps(Phase::costs, c);
  const auto count = [&](Phase phase) {
    return int(
        std::ranges::count_if(synthesis_steps(), [&](const Step& s) { return s.phase == phase && s.applies(facts_); }));
  };
  first_steps_ = count(facts_.coarsest() ? Phase::coarsest : Phase::upsampling);
  steps_ = first_steps_ + effort_.passes * (count(Phase::before_pass) + counts_of(Phase::pass) * count(Phase::pass));
}

Field LevelWork::coarsest_field() {
  Field field;
  const CorrectionLevel level = correction_level(PlaneWindow::all_of(shared_.plane(facts_.level)), fixed_);
  StepContext c = context(level, field);
  run(Phase::coarsest, c);
  return field;
}

Field LevelWork::upsampled_blocks(const Field& parent, const PlaneWindow& window) {
  Field starts;
  const FixedPixels fixed = shared_.fixed(facts_.level + 1);
  CorrectionLevel level = correction_level(window, fixed);
  level.block = 2;
  StepContext c = context(level, starts);
  c.parent = &parent;
  run(Phase::upsampling, c);
  return starts;
}

void LevelWork::count_use(std::span<const ExemplarPixel> starts) {
  if (facts_.level <= finest_whole_level) usage_.freeze_counts(starts, shared_.fixed(facts_.level + 1));
}

Field LevelWork::initial_field(std::span<const ExemplarPixel> starts, const PlaneWindow& from,
                               const PlaneWindow& window) const {
  Field field = expanded(starts, from, window, exemplar_);
  fixed_.apply(field, window);
  return field;
}

void LevelWork::correct(Field& field, const PlaneWindow& window, const Rect& wanted) {
  if (candidates_.empty())
    candidates_ = unpacked(shared_.index.levels()[size_t(facts_.level)], shared_.exemplar(facts_.level).size);
  const CorrectionLevel level = correction_level(window, fixed_);
  StepContext c = context(level, field);
  c.wanted = wanted;
  done_ = std::max(done_, first_steps_);  // parts of the finest level begin with what has been made for all of it
  for (; c.pass < effort_.passes; c.pass++) {
    run(Phase::before_pass, c);
    run(Phase::pass, c);
  }
}

void LevelWork::run(Phase phase, StepContext& c) {
  const int counts = counts_of(phase);
  c.task = shared_.task.part([this, counts](double part) { report(done_ + counts * part); });
  run_steps(phase, c, [&] { report(done_ += counts); });
}

void LevelWork::report(double steps) const {
  // Every finer level has four times as many pixels; all coarser ones together, a third of them.
  const double coarser = facts_.coarsest() ? 0 : 1.0 / 3, part = std::min(1.0, steps / std::max(1, steps_));
  const double here = (coarser + part) / (coarser + 1);
  shared_.task.progress(std::ldexp(here, -2 * (facts_.level - shared_.finest)));
}

StepContext LevelWork::context(const CorrectionLevel& level, Field& field) {
  return {shared_, facts_, effort_, level, fixed_, usage_, field};
}

CorrectionLevel LevelWork::correction_level(const PlaneWindow& window, const FixedPixels& fixed) const {
  return {exemplar_,
          candidates_,
          shared_.index.levels()[size_t(facts_.level)].per_pixel,
          facts_.level,
          window,
          phase_,
          fixed,
          control_.get(),
          facts_.lays_elements() ? shared_.index.appearance()->elements()->at.data() : nullptr};
}

}  // namespace terrazzo
