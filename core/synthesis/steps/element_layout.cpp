#include "core/synthesis/steps/element_layout.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "core/base/tuning.h"
#include "core/synthesis/steps/element_packing.h"
#include "core/synthesis/steps/element_places.h"
#include "core/synthesis/steps/element_shapes.h"
#include "core/synthesis/steps/element_warp.h"

namespace terrazzo {

namespace {

struct ElementLayoutTuning {
  double least_shown = 0.4;
  double least_shown_at_border = 0.15;
  double least_kept = 0.03;
  int fewest = 4;
  double sure_outlines = 0.65;
};
const Tunable<ElementLayoutTuning> element_layout_tuning(
    "element_layout",
    {
        {&ElementLayoutTuning::least_shown, "least_shown", "of an element",
         "that the field must show for it to stay. Higher: more is laid anew; lower: what stays fits less",
         "element_layout", 0, 1},
        {&ElementLayoutTuning::least_shown_at_border, "least_shown_at_border", "of an element",
         "the same where the result's border cuts it", "What each rule decides", 0, 1},
        {&ElementLayoutTuning::least_kept, "least_kept", "of an element",
         "that must be kept for all of it to be shown. Higher: more is cut where kept pixels end; lower: crumbs count",
         "What each rule decides", 0, 1},
        {&ElementLayoutTuning::fewest, "fewest", "elements",
         "that an exemplar must have whole. Higher: few large stones are torn; lower: they come back and back",
         "What each rule decides", 1},
        {&ElementLayoutTuning::sure_outlines, "sure_outlines", "certainty",
         "from which on rims are bent to meet in joints. Higher: walls lose joints; lower: pebbles get ragged rims",
         "heaped_elements", 0, 1},
    });

class ElementLayout {
 public:
  ElementLayout(Field& field, const CorrectionLevel& level, const Appearance& appearance)
      : field_(field),
        level_(level),
        places_(field, level, appearance),
        shapes_(places_.shapes()),
        packing_(shapes_, level.window.field()) {}

  void lay(ElementRims rims, const Task& task) {
    Places places = places_.shown();
    std::vector<PlacedElement> placed;
    for (auto& of_element : places)
      for (ShownElement& s : of_element) {
        s.placed.stays = is_continued(s);
        if (s.placed.stays || is_shown(s)) placed.push_back(s.placed);
      }
    if (level_.fixed.any()) packing_.keep_off(kept_without(places));
    packing_.pack(std::move(placed), task);
    warps_.resize(packing_.placed().size());
    if (rims == ElementRims::bent)
      tbb::parallel_for(0, int(warps_.size()), [&](int i) { warps_[size_t(i)] = ElementWarp(shapes_, packing_, i); });
    tbb::parallel_for(0, field_.size.height, [&](int row) {
      for (int column = 0; column < field_.size.width; column++) show(column, row);
    });
  }

 private:
  using Places = std::vector<std::vector<ShownElement>>;

  /// Whether an element that is partly kept goes on beyond that.
  bool is_continued(const ShownElement& s) const {
    const ElementShape& shape = shapes_[s.placed.element];
    return !shape.unusable && s.kept > 0 && double(s.kept) >= element_layout_tuning->least_kept * double(shape.area);
  }

  /// The kept blocks that show none of the elements that go on.
  std::vector<uint8_t> kept_without(const Places& places) const {
    std::vector<uint8_t> out(field_.pixels.size());
    for (int row = 0; row < field_.size.height; row++)
      for (int column = 0; column < field_.size.width; column++) {
        if (!level_.is_fixed(column, row)) continue;
        const PlacedElement at = places_.element_at(column, row);
        const ShownElement* s = places_.find(places[size_t(at.element)], at);
        out[size_t(row) * size_t(field_.size.width) + size_t(column)] = !s || !s->placed.stays;
      }
    return out;
  }

  /// Whether the field shows an element for the most part.
  bool is_shown(const ShownElement& s) const {
    const ElementShape& shape = shapes_[s.placed.element];
    if (shape.unusable) return false;
    const int x = shapes_.column_of(s.placed) + shape.box.x, y = shapes_.row_of(s.placed) + shape.box.y;
    const bool inside_x = level_.window.closed_x || (x >= 0 && x + shape.box.width <= field_.size.width);
    const bool inside_y = level_.window.closed_y || (y >= 0 && y + shape.box.height <= field_.size.height);
    const double least =
        inside_x && inside_y ? element_layout_tuning->least_shown : element_layout_tuning->least_shown_at_border;
    return double(s.blocks) >= least * double(shape.area);
  }

  void show(int column, int row) {
    const ElementPacking::Place& place = *packing_.find(column, row);
    if (place.placed < 0 || level_.is_fixed(column, row)) return;
    const PlacedElement& p = packing_.placed()[size_t(place.placed)];
    int x = column - shapes_.column_of(p), y = row - shapes_.row_of(p);
    if (level_.window.closed_x) x = nearest_to_zero(x, field_.size.width);
    if (level_.window.closed_y) y = nearest_to_zero(y, field_.size.height);
    const ElementWarp::At to = warps_[size_t(place.placed)]({double(x), double(y)});
    // What is not moved keeps its shift, which need not be whole blocks.
    const int u =
        (x + shapes_.column_of(p)) * level_.block + p.shift_x + int(std::floor((to.x - x) * level_.block + 0.5));
    const int v = (y + shapes_.row_of(p)) * level_.block + p.shift_y + int(std::floor((to.y - y) * level_.block + 0.5));
    field_.at(column, row) = places_.inside(u, v);
  }

  Field& field_;
  const CorrectionLevel& level_;
  ElementPlaces places_;
  const ElementShapes& shapes_;
  ElementPacking packing_;
  std::vector<ElementWarp> warps_;  // of each placed element
};

}  // namespace

bool has_elements(const Appearance& appearance) {
  const ElementsPtr& e = appearance.elements();
  return e && whole_elements(*e, appearance.wraps()) >= element_layout_tuning->fewest;
}

bool are_heaped(const Appearance& appearance) {
  const ElementsPtr& e = appearance.elements();
  return e && appearance.lattice().rank == 0 && e->certainty < element_layout_tuning->sure_outlines;
}

void lay_elements(Field& field, const CorrectionLevel& level, const Appearance& appearance, ElementRims rims,
                  const Task& task) {
  ElementLayout layout(field, level, appearance);
  layout.lay(rims, task);
}

}  // namespace terrazzo
