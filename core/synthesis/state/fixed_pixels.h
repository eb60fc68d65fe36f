#pragma once

#include <vector>

#include "core/exemplar/lattice.h"
#include "core/synthesis/state/field.h"
#include "core/synthesis/state/plane_window.h"

namespace terrazzo {

/// How long an output pixel that is given stays as it is. Those that are kept at first may be replaced later, so that
/// the seam between old and new can look for its place. Moving seams never restores what a pixel of `never` showed.
enum class Keep : uint8_t { never, at_first, always };

/// Output pixels that are given.
struct ExistingPixels {
  std::vector<ExemplarPixel> pixels{};  ///< what each output pixel shows; arbitrary where `keep` is `never`
  std::vector<Keep> keep{};             ///< of each output pixel; both are empty if none is kept
  bool empty() const { return keep.empty(); }
  /// The gaps between those that always stay, around the border of a result of that size: a lattice can bend there.
  LatticeGaps gaps(Size output) const;
};

/// The fixed pixels of a level: those all of whose finest pixels are always kept. Thread-safe to read.
class FixedPixels {
 public:
  /// Nothing is fixed.
  FixedPixels() = default;
  /// `output`: the finest level's size; `exemplar`: the exemplar's at `level`, 0 = the finest.
  FixedPixels(const ExistingPixels& kept, Size output, int level, Size exemplar);

  /// Whether any of the output's pixels is given, fixed on this level or not.
  bool any() const { return !fixed_.empty(); }
  bool at(size_t pixel) const { return !fixed_.empty() && fixed_[pixel]; }
  /// Whether `shown`, of this level, is what a pixel with Keep::never showed before.
  bool is_past(size_t pixel, ExemplarPixel shown) const { return any() && !begin_[pixel] && pixels_[pixel] == shown; }
  /// What a fixed pixel shows.
  ExemplarPixel shown(size_t pixel) const { return pixels_[pixel]; }
  /// Puts the fixed pixels into a field of the level.
  void apply(Field& field, const PlaneWindow& window) const;
  /// The same when a field is initialized: pixels that are kept at first, too.
  void begin(Field& field, const PlaneWindow& window) const;

 private:
  void put(const std::vector<uint8_t>& which, Field& field, const PlaneWindow& window) const;

  std::vector<uint8_t> fixed_;
  std::vector<uint8_t> begin_;  // whether the finest pixel in the middle is kept at first
  std::vector<ExemplarPixel> pixels_;
};

}  // namespace terrazzo
