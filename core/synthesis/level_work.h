#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/synthesis/steps/correction.h"
#include "core/synthesis/steps/seams.h"
#include "core/synthesis/synthesize.h"

namespace terrazzo {

/// The finest level that is worked out for the plane as a whole: patches are laid, pieces aligned and their seams moved
/// on every level but the finest.
inline constexpr int finest_whole_level = 1;

/// What all levels of a synthesis share. What it is made from must outlive it.
struct SharedWork {
  SharedWork(const Index& index, const SynthesisOptions& options, const Task& task)
      : index(index),
        options(options),
        task(task),
        levels(int(index.levels().size())),
        lattice(index.appearance()->lattice()),
        gaps(options.kept.gaps(options.size)),
        controls(options.controls, index.appearance()->size(), options.size, levels, task) {}

  const AppearanceLevel& exemplar(int level) const { return index.appearance()->levels()[level]; }
  Plane plane(int level) const;
  double jitter(int level) const;
  /// Rare features are won or lost at the coarsest levels.
  bool places_landmarks(int level) const;
  FixedPixels fixed(int level) const { return {options.kept, options.size, level, exemplar(level).size}; }

  const Index& index;
  const SynthesisOptions& options;
  const Task& task;
  int levels;
  Lattice lattice;
  LatticeGaps gaps;  ///< between kept pixels
  ControlPyramid controls;
  int finest = 0;  ///< the level that ends the work
};

/// The work on one level.
class LevelWork {
 public:
  LevelWork(const SharedWork& shared, int level);

  /// What the coarsest level begins with.
  Field beginning() const;

  /// Where the pixels of the next coarser level lead on this one.
  Field starts(const Field& parent, const PlaneWindow& window);

  /// Lets evenness count what the pixels of all the plane's blocks begin with, and no more from then on.
  void count_use(std::span<const ExemplarPixel> starts);

  /// A field of this level, begun with `starts` as far as `from` holds them.
  Field begun(std::span<const ExemplarPixel> starts, const PlaneWindow& from, const PlaneWindow& window) const;

  /// Makes the wanted columns and rows right.
  void correct(Field& field, const PlaneWindow& window, const Rect& wanted);

  /// How far beyond what is wanted of this level a field must reach.
  int reach() const;

 private:
  struct Effort;
  static Effort effort_at(int level, Quality quality, bool between_kept, bool coarsest);
  Effort effort() const;
  bool limits_pieces() const;
  double coherence() const;
  /// Seams between courses or tiles show more than others, and so do those along an outline that was drawn. Measured on
  /// other exemplars moving seams brings nothing.
  bool moves_seams() const;
  /// The first time that seams move. Measured on exemplars without a lattice this brings nothing either, and controls
  /// say where pieces belong.
  bool refills() const;
  /// Bricks are laid whole where only seams still move, before they look for the pixel.
  bool lays_bricks() const;
  /// How seams move then; nothing if the exemplar has no bricks.
  std::optional<SeamMoves> lay(Field& starts, const CorrectionLevel& level) const;
  /// Of blocks of two by two pixels.
  SeamMoves to_joints() const;
  bool mends(int passes_left) const;
  /// Places unlike any of the exemplar's. Measured on lattices this brings next to nothing.
  bool reworks() const;
  bool regular() const { return shared_.lattice.rank > 0; }

  /// Measured on lattices this breaks more and makes nothing more like the exemplar.
  bool insists_on_evenness() const;
  /// On lattices everything near by is alike, and controls say what belongs where.
  bool looks_around() const { return !regular() && !control_; }

  /// Only when asked for: where a level merely begins none are needed, and they may be many.
  void find_similar();
  CorrectionLevel correction_level(const PlaneWindow& window, const std::vector<ExemplarPixel>& similar,
                                   const FixedPixels& fixed) const;
  void start_where_fixed(Field& starts, const FixedPixels& fixed, const PlaneWindow& window) const;

  const SharedWork& shared_;
  int level_;
  PaddedLevel exemplar_;
  PartPhases phase_;
  FixedPixels fixed_;
  std::unique_ptr<const LevelControl> control_;
  UsagePenalty usage_;
  std::vector<ExemplarPixel> similar_;  // once it is asked for
};

}  // namespace terrazzo
