#include "core/synthesis/state/control_map.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace terrazzo {

void require_control(Control::Mode mode, const ImageFacts& exemplar_control, const ImageFacts& target,
                     std::optional<Size> exemplar) {
  require_shape("exemplar_control", exemplar_control, "the exemplar", exemplar);
  if (!exemplar_control.channels || !target.channels || *exemplar_control.channels == *target.channels) return;
  const auto is_grey_or_colour = [](const ImageFacts& i) { return *i.channels == 1 || *i.channels == 3; };
  if (mode == Control::Mode::labels && is_grey_or_colour(exemplar_control) && is_grey_or_colour(target)) return;
  throw Error("target", fmt::format("expected as many channels as \"exemplar_control\", {}; found {}; put "
                                    "\"grayscale\" before both, say",
                                    describe(exemplar_control), describe(target)));
}

}  // namespace terrazzo
