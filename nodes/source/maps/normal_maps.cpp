#include "nodes/source/maps/normal_maps.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/naming/interpretation.h"

namespace terrazzo {

RebuiltNormals rebuilt_normals(const ImagePtr& image, const NormalFile& file, const Image* height,
                               std::vector<std::string>& notes) {
  const std::string subject = (file.map.empty() ? "" : file.map + ": ") + file.place;
  NormalLayout layout;
  try {
    layout = normal_layout(image, file.names, height, file.channels, advice_to_interpret(file.map, "xy"));
  } catch (const Error& e) {
    throw Error("path", fmt::format("{}: {}", subject, e.what()));
  }
  if (!layout.doubt.empty())
    notes.push_back(
        fmt::format("{}{}: {}; it may hold another map. It is taken for z; {} rebuilds z from red and green",
                    warning_mark, subject, layout.doubt, advice_to_interpret(file.map, "xy")));
  if (layout.has_z) return {};
  notes.push_back(fmt::format("{}: {}; z is rebuilt from x and y", subject, layout.reason));
  if (layout.overlong > 0.001)
    notes.push_back(fmt::format("{}{}: in {:.1f} % of the pixels x and y are longer than a normal; z is 0 there",
                                warning_mark, subject, 100 * layout.overlong));
  const int channels = image->channels();
  return {with_z_rebuilt(image, layout), channels % 2 == 0 && std::max(layout.x, layout.y) == channels - 1};
}

}  // namespace terrazzo
