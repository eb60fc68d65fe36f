#pragma once

#include <cstdint>
#include <string>

#include "core/base/task.h"
#include "core/exemplar/features.h"

namespace terrazzo {

/// By which of two ways a surface is made of an exemplar: a layout of its pixels, which keeps features whole, or noise
/// by example, which blends samples of it.
enum class Method : uint8_t { layout, noise };

struct MethodChoice {
  Method method = Method::layout;
  std::string why;  ///< a clause, for people

  /// "a layout suits it: it repeats".
  std::string sentence() const;
};

/// How far an exemplar is from a Gaussian texture, which noise by example reproduces exactly: the largest excess
/// kurtosis of its derivatives and bands along the leading component of all channels, Gaussianised, over up to three
/// scales. About 0 for Gaussian noise; more where features stand out, such as cracks, joints, leaves and pebbles. 0
/// also below 64 pixels a side, where nothing can be said. The same on every machine. Throws Cancelled.
double structure(const Features& features, const Task& task);

/// Which way suits an exemplar whose lattice and elements have been looked for. Noise only where nothing is to be kept
/// whole: no lattice, no elements, and hardly any structure. Throws Cancelled.
MethodChoice suitable_method(const Features& features, const Task& task);

}  // namespace terrazzo
