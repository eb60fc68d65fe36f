#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/exemplar/features.h"
#include "core/exemplar/fingerprint.h"
#include "core/image/float_planes.h"
#include "core/material/material.h"

/// Tells whether a material is the one that an analysis was made of. Thread-safe.
namespace terrazzo {

/// `channels`: the features' weighted channels, as they are outside a mask too.
Fingerprint fingerprint_of(const Features& features, const Planes& channels);

/// How much the maps that both have are alike.
struct Likeness {
  double correlation = 0;         ///< of the channel that is most alike, 0..1; an inverted map is alike
  std::vector<std::string> maps;  ///< that were compared
};

/// Compares maps of the same names until one is alike. Size, tone, and the colours of a repainted map do not matter,
/// but where what lies does. Nothing if no map can be compared: none has the same name, or all are too small or of one
/// colour. Pulls the maps that it compares. Throws Cancelled.
std::optional<Likeness> likeness(const Fingerprint& analysed, const Material& material, const Task& task);

/// A material that is less alike is another one.
double least_likeness();

}  // namespace terrazzo
