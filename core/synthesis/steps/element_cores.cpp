#include "core/synthesis/steps/element_cores.h"

#include <algorithm>

#include "core/base/tuning.h"
#include "core/synthesis/steps/element_places.h"

namespace terrazzo {

namespace {

struct ElementCoresTuning {
  double rim = 1;
};
const Tunable<ElementCoresTuning> element_cores_tuning(
    "element_cores", {{&ElementCoresTuning::rim, "rim", "blocks",
                       "from the middle of its joint that an element does not take. Higher: corners stay torn; "
                       "lower: thin joints break",
                       "element_cores", 0, 100}});

}  // namespace

void complete_elements(Field& field, const CorrectionLevel& level, const Appearance& appearance) {
  const ElementPlaces places(field, level, appearance);
  const ElementShapes& shapes = places.shapes();
  std::vector<ShownElement> shown;
  for (const auto& of_element : places.shown())
    for (const ShownElement& s : of_element)
      if (!shapes[s.placed.element].unusable) shown.push_back(s);
  std::ranges::stable_sort(shown, [](const ShownElement& a, const ShownElement& b) { return a.blocks > b.blocks; });
  const Plane plane = level.window.field();
  std::vector<uint8_t> taken(field.pixels.size());
  for (const ShownElement& s : shown) {
    const ElementShape& shape = shapes[s.placed.element];
    const int left = shapes.column_of(s.placed), top = shapes.row_of(s.placed);
    for (int y = shape.box.y; y < shape.box.bottom(); y++)
      for (int x = shape.box.x; x < shape.box.right(); x++) {
        if (double(shape.depth(x, y)) < element_cores_tuning->rim) continue;
        const int64_t at = plane.index(left + x, top + y);
        if (at < 0 || taken[size_t(at)]) continue;
        taken[size_t(at)] = 1;
        if (level.is_fixed(int(at % field.size.width), int(at / field.size.width))) continue;
        field.pixels[size_t(at)] =
            places.inside((left + x) * level.block + s.placed.shift_x, (top + y) * level.block + s.placed.shift_y);
      }
  }
}

}  // namespace terrazzo
