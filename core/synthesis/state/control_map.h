#pragma once

#include <cstdint>
#include <optional>

#include "core/image/image.h"
#include "core/image/image_facts.h"

namespace terrazzo {

/// A guidance map: steers which part of the exemplar goes where (texture transfer, Efros & Freeman 2001; layouts
/// painted with labels, Hertzmann et al. 2001). Exemplar pixels are preferred where their control is like the target's.
struct Control {
  enum class Mode : uint8_t {
    values,  ///< grey values or colours: the nearer, the better
    labels,  ///< values are names: two are the same label or they are not
  };
  enum class Match : uint8_t {
    none,       ///< the target's values mean what the exemplar's mean
    range,      ///< its darkest and lightest values become the exemplar control's, per channel
    histogram,  ///< its values become the exemplar control's values of equal rank, per channel
  };
  ImagePtr exemplar;  ///< of the exemplar's shape
  ImagePtr target;    ///< as many channels, but that labels may be grey or colours; stretched over the output
  double strength = 1;
  Mode mode = Mode::values;
  Match match = Match::histogram;  ///< only for values
  double leeway = 0;               ///< only for labels: output pixels by which borders between labels may move
};

/// Throws Error about "exemplar_control" or "target" if they certainly do not fit the exemplar or one another.
void require_control(Control::Mode mode, const ImageFacts& exemplar_control, const ImageFacts& target,
                     std::optional<Size> exemplar);

}  // namespace terrazzo
