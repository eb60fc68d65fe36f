#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/synthesis/steps.h"

namespace terrazzo {

/// The work on one level: holds what the steps of that level share, and runs them. Used by one thread.
class LevelWork {
 public:
  LevelWork(const SharedWork& shared, int level);

  /// What the coarsest level starts from.
  Field coarsest_field();

  /// What a field of the next coarser level starts this one from: each of its pixels stands for a block of 2x2 pixels
  /// and names what the first of them shows.
  Field upsampled_blocks(const Field& parent, const PlaneWindow& window);

  /// Counts the use of the exemplar by all the plane's blocks, on fine levels for the last time: parts must not depend
  /// on one another.
  void count_use(std::span<const ExemplarPixel> starts);

  /// The pixels of the blocks in `window`; `from`: the part of the coarser plane that `starts` covers.
  Field initial_field(std::span<const ExemplarPixel> starts, const PlaneWindow& from, const PlaneWindow& window) const;

  /// Makes the wanted columns and rows right.
  void correct(Field& field, const PlaneWindow& window, const Rect& wanted);

  /// By how many pixels the field of a part must reach beyond what is wanted of it.
  int reach() const { return reach_of(effort_.passes); }

 private:
  /// Runs the steps of a phase, and reports how far that is.
  void run(Phase phase, StepContext& c);
  /// Reports progress after so many of the level's steps.
  void report(double steps) const;
  StepContext context(const CorrectionLevel& level, Field& field);
  CorrectionLevel correction_level(const PlaneWindow& window, const FixedPixels& fixed) const;

  const SharedWork& shared_;
  LevelFacts facts_;
  Effort effort_;
  PaddedLevel exemplar_;
  PartPhases phase_;
  FixedPixels fixed_;
  std::unique_ptr<const LevelControl> control_;
  UsagePenalty usage_;
  int steps_ = 0;        // that run on this level, each as often as it does; corrections count several times
  int first_steps_ = 0;  // of them, before the corrections
  int done_ = 0;
  std::vector<ExemplarPixel> candidates_;  // k-coherent, of every exemplar pixel; once corrections begin
};

}  // namespace terrazzo
