#pragma once

#include <cstdint>
#include <vector>

#include "core/base/task.h"
#include "core/synthesis/state/control_map.h"

/// Controls of mode labels: numbers the labels and finds the areas where borders between them may move.
namespace terrazzo {

inline constexpr size_t most_labels = 32;  ///< more different values are a picture rather than labels

/// The labels of an exemplar's control and of the target, row by row: numbers below `count`.
struct PaintedLabels {
  int count = 0;
  std::vector<uint8_t> exemplar;
  std::vector<uint8_t> target;  ///< values that the exemplar does not have are given the nearest label
  double unknown = 0;           ///< the share of the target that has such values, 0..1
  int wanted = 0;               ///< how many of the labels the target shows
};

/// Reads a control of mode labels at those sizes, by nearest pixels. A grey image can be laid out by a coloured one and
/// the other way around. Throws Error about "exemplar_control" if that has too many labels, about "target" if colours
/// cannot be compared, and Cancelled.
PaintedLabels painted_labels(const Control& control, Size exemplar, Size output, const Task& task);

/// How much each label is wanted at every pixel of a result of that size, in 255ths: `count` bytes per pixel. One label
/// takes all of it, except within `leeway` pixels of others: there all labels that are so near share it. Areas thinner
/// than twice the leeway, and the tips of sharp corners, have no leeway, so that they are not lost.
std::vector<uint8_t> wanted_labels(const std::vector<uint8_t>& target, int count, Size size, double leeway,
                                   const Task& task);

}  // namespace terrazzo
