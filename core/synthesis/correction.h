#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/analysis/padded_level.h"
#include "core/repeats.h"
#include "core/synthesis/comparison_window.h"
#include "core/synthesis/control.h"
#include "core/synthesis/field.h"
#include "core/synthesis/kept.h"
#include "core/synthesis/plane_window.h"
#include "core/task.h"

namespace terrazzo {

/// Costs are multiplied by factors of 1/4096 (integers, so that every machine decides alike).
inline constexpr uint32_t unit_factor = 4096;

/// How often each cell of the exemplar (it is divided into 16x16) is in use, as a factor on the cost of using it once
/// more: above 1 where use exceeds an even share, and once all of the cell, below 1 where it falls short of it.
class Occupancy {
 public:
  /// `weight`: how much a doubled use adds to the cost; 0 turns the term off. `least_factor`: what the cost of
  /// a cell that is used too little falls to at most. `demand`: how often each exemplar pixel is wanted, relative to
  /// the others; empty: all alike.
  Occupancy(Size exemplar, double weight, double least_factor, const std::vector<double>& demand = {});
  /// Fixed pixels do not count.
  void recount(const Field& field, const FixedPixels& fixed);
  /// The same once and for all: recount() does nothing from now on.
  void count_for_good(std::span<const ExemplarPixel> pixels, const FixedPixels& fixed);
  /// From now on every count makes what is used too much dearer than the last, and what is used too little cheaper (the
  /// integral part of a controller): what fits badly everywhere would otherwise be used too little for ever.
  void insist();
  bool active() const { return weight_ > 0; }
  uint32_t factor(int x, int y) const { return factors_[row_starts_[y] + columns_of_[x]]; }

 private:
  void count(std::span<const ExemplarPixel> pixels, const FixedPixels& fixed);

  double weight_;
  double least_factor_;
  bool settled_ = false;
  int cell_;
  int columns_;
  int rows_;
  std::vector<uint32_t> columns_of_;  // the cells' column of every x
  std::vector<uint32_t> row_starts_;  // the first cell of every y's row of cells
  std::vector<double> areas_;         // of the cells: their usable pixels
  std::vector<double> shares_;        // of all use, by cell; empty: all alike
  std::vector<double> prices_;        // what all counts have made of each cell; empty: only the last matters
  std::vector<uint32_t> factors_;
};

/// What the correction of one level works with.
struct CorrectionLevel {
  const PaddedLevel& exemplar;
  const std::vector<ExemplarPixel>& similar;  ///< per_pixel positions for every exemplar pixel
  int per_pixel = 0;
  int level = 0;       ///< 0 = finest; part of every random choice
  PlaneWindow window;  ///< what the field holds of the plane
  PartPhases phase;    ///< of a regular exemplar: every output pixel keeps its place in the lattice's cell
  FixedPixels fixed;   ///< pixels of the plane that are not corrected
  const LevelControl* control = nullptr;  ///< null: nothing steers
};

struct CorrectionPass {
  const Window* window = nullptr;
  uint32_t coherence = unit_factor;  ///< factor on candidates that continue a neighbour
  /// If not empty, per output pixel instead: the factor on continuing the piece it is in.
  std::vector<uint32_t> piece_coherence{};
  int random_candidates = 0;
  uint64_t seed = 0;
  int pass = 0;
  Rect wanted;  ///< the columns and rows that have to be right after the pass; it spoils others
};

/// How far beyond a pixel its correction looks, in each of a pass's sub-passes.
inline constexpr int correction_reach = 6;
inline constexpr int sub_passes = 4;

/// One correction pass (Lefebvre & Hoppe 2005, section 4.3): every pixel takes the best of its neighbours'
/// continuations, their similar pixels and some random places. It runs as four sub-passes over interleaved pixels, each
/// of which reads what the one before has left: the result does not depend on the order of work, nor on which part of
/// the plane the field holds. Throws Cancelled.
void correct(Field& field, const CorrectionLevel& level, const CorrectionPass& pass, Occupancy& occupancy,
             const Task& task);

}  // namespace terrazzo
