#pragma once

#include <cmath>

#include "core/hash.h"

namespace terrazzo {

struct Vector2 {
  double x = 0;
  double y = 0;
};

/// How an exemplar repeats. Rank 2: in two directions, by `first` and `second` (pixels of the finest level). Rank 1: in
/// bands across one axis only: courses (first = (0, height)) or columns (first = (width, 0)); along the bands anything
/// goes. Rank 0: it does not.
struct Lattice {
  int rank = 0;
  Vector2 first;
  Vector2 second;
  double certainty = 0;  ///< how much repeats exceed chance, 0..1

  void add_to(Hasher& h) const {
    h.add(rank).add(first.x).add(first.y).add(second.x).add(second.y).add(certainty);
  }
};

/// Measures displacements against a lattice, at the scale of one pyramid level. Basic arithmetic only, so every machine
/// decides alike.
class LatticePhase {
 public:
  /// `level`: 0 = the finest.
  LatticePhase(const Lattice& lattice, int level) : rank_(lattice.rank) {
    const double scale = 1.0 / double(int64_t{1} << level);
    a_ = {lattice.first.x * scale, lattice.first.y * scale};
    b_ = {lattice.second.x * scale, lattice.second.y * scale};
    const double determinant = a_.x * b_.y - a_.y * b_.x;
    if (rank_ == 2) inverse_ = 1.0 / determinant;
  }

  bool active() const { return rank_ > 0; }

  /// What a displacement lacks to the nearest lattice vector (to the nearest whole band, for rank 1).
  Vector2 excess(double dx, double dy) const {
    if (rank_ == 1) {
      if (a_.x != 0) return {dx - a_.x * nearest(dx / a_.x), 0};
      return {0, dy - a_.y * nearest(dy / a_.y)};
    }
    const double i = nearest((dx * b_.y - dy * b_.x) * inverse_), j = nearest((dy * a_.x - dx * a_.y) * inverse_);
    return {dx - i * a_.x - j * b_.x, dy - i * a_.y - j * b_.y};
  }

  static double nearest(double v) { return std::floor(v + 0.5); }

 private:
  int rank_;
  Vector2 a_, b_;
  double inverse_ = 0;
};

}  // namespace terrazzo
