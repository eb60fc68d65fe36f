#pragma once

#include <cstdint>
#include <vector>

#include "core/synthesis/state/control.h"

/// Controls whose values are things of their own: which of them is where.
namespace terrazzo {

inline constexpr size_t most_labels = 32;

/// The labels of an exemplar's control, and where they, and those of the target, are: numbers below `count`, row by
/// row.
struct PaintedLabels {
  int count = 0;
  std::vector<uint8_t> exemplar;
  std::vector<uint8_t> target;  ///< where its value is none of the exemplar's, the nearest
  double unknown = 0;           ///< the part of the target where that is so, 0..1
  int wanted = 0;               ///< how many of the labels the target shows
};

/// Reads a control of mode labels at those sizes, nearest pixels. A grey image can be laid out by a coloured one and
/// the other way around. Throws Error about "exemplar_control" if that has too many labels, about "target" if colours
/// cannot be compared, and Cancelled.
PaintedLabels painted_labels(const Control& control, Size exemplar, Size output, const Task& task);

/// How much each label is wanted at every pixel of a result of that size, in 255ths: `count` bytes per pixel. All of
/// one label is, except up to `leeway` pixels from another: there each that is so near is wanted as much. What is
/// thinner than twice that has no leeway, nor have the tips of sharp corners, so that nothing is lost.
std::vector<uint8_t> wanted_labels(const std::vector<uint8_t>& target, int count, Size size, double leeway,
                                   const Task& task);

}  // namespace terrazzo
