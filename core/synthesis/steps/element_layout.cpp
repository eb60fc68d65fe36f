#include "core/synthesis/steps/element_layout.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <tbb/parallel_for.h>

#include "core/base/tuning.h"
#include "core/synthesis/steps/element_packing.h"
#include "core/synthesis/steps/element_shapes.h"

namespace terrazzo {

namespace {

struct Tuning {
  double least_shown = 0.4;
  double least_shown_at_border = 0.15;
  int same_place = 4;
  int fewest = 4;
  double bend_depth = 0.6;
  double unseen = 0.75;
  int bend_steps = 3;
};
const Tunable<Tuning> tuning(
    "element_layout",
    {
        {&Tuning::least_shown, "least_shown", "of an element",
         "that the field must show for it to stay. Higher: more is laid anew; lower: what stays fits less",
         "element_layout", 0, 1},
        {&Tuning::least_shown_at_border, "least_shown_at_border", "of an element",
         "the same where the result's border cuts it", "not measured: chosen by eye", 0, 1},
        {&Tuning::same_place, "same_place", "pixels", "within which an element is in one place",
         "not measured: seams jog by less", 0, 64},
        {&Tuning::fewest, "fewest", "elements",
         "that an exemplar must have whole. Higher: large tiles keep to their lattice; lower: they come back and back",
         "not measured: fewer are no choice", 1},
        {&Tuning::bend_depth, "bend_depth", "inner radii",
         "how deep elements bend. Higher: softer, but more of them; lower: only the rim, which is squeezed more",
         "element_layout", 0.01, 1},
        {&Tuning::unseen, "unseen", "blocks", "by which neighbours may miss each other without being bent",
         "element_layout", 0, 100},
        {&Tuning::bend_steps, "bend_steps", "steps", "of following the outline. Costs time", "element_layout", 1, 32},
    });

/// Where an element of the exemplar lies when it is shown with a shift.
struct Vote {
  int element, shift_x, shift_y;
  auto operator<=>(const Vote&) const = default;
};

class ElementLayout {
 public:
  ElementLayout(Field& field, int block, const CorrectionLevel& level, const Appearance& appearance)
      : field_(field),
        block_(block),
        level_(level),
        elements_(*appearance.elements()),
        wraps_(appearance.wraps()),
        shapes_(element_shapes(elements_, appearance.levels().front().usable, block, wraps_)),
        packing_(shapes_, field.size, level.window.closed_x, level.window.closed_y) {}

  void lay(const Task& task) {
    packing_.pack(shown(), task);
    tbb::parallel_for(0, field_.size.height, [&](int row) {
      for (int column = 0; column < field_.size.width; column++) show(column, row);
    });
  }

 private:
  /// The shift from a block of the field to what it shows, such that the element comes out in one piece where the
  /// exemplar tiles.
  Vote vote_of(int column, int row) const {
    const ExemplarPixel& p = field_.at(column, row);
    const int element = elements_.at[size_t(p.y) * size_t(elements_.size.width) + p.x];
    const ElementShape& shape = shapes_[element];
    const auto unwrapped = [&](int at, int centre, int length) {
      return wraps_ ? centre + wrap(at - centre + length / 2, length) - length / 2 : at;
    };
    return {element, unwrapped(p.x, shape.centre_x * block_, elements_.size.width) - column * block_,
            unwrapped(p.y, shape.centre_y * block_, elements_.size.height) - row * block_};
  }

  /// How many blocks show an element in a place.
  struct Shown {
    PlacedElement placed;
    int64_t blocks = 0;
  };

  /// The elements that the field shows for the most part.
  std::vector<PlacedElement> shown() const {
    std::map<Vote, int64_t> votes;
    for (int row = 0; row < field_.size.height; row++)
      for (int column = 0; column < field_.size.width; column++) votes[vote_of(column, row)]++;
    std::vector<std::pair<Vote, int64_t>> by_size(votes.begin(), votes.end());
    std::ranges::stable_sort(by_size, [](const auto& a, const auto& b) { return a.second > b.second; });
    std::vector<std::vector<Shown>> places(shapes_.all.size());
    for (const auto& [vote, blocks] : by_size) add_to_nearest(places[size_t(vote.element)], vote, blocks);
    std::vector<PlacedElement> out;
    for (const auto& of_element : places)
      for (const Shown& s : of_element)
        if (stays(s)) out.push_back(s.placed);
    return out;
  }

  void add_to_nearest(std::vector<Shown>& places, const Vote& vote, int64_t blocks) const {
    const int reach = tuning->same_place;
    for (Shown& s : places)
      if (std::abs(s.placed.shift_x - vote.shift_x) <= reach && std::abs(s.placed.shift_y - vote.shift_y) <= reach) {
        s.blocks += blocks;
        return;
      }
    places.push_back({{vote.element, vote.shift_x, vote.shift_y}, blocks});
  }

  bool stays(const Shown& s) const {
    const ElementShape& shape = shapes_[s.placed.element];
    if (shape.cut) return false;
    const int x = packing_.column_of(s.placed) + shape.box.x, y = packing_.row_of(s.placed) + shape.box.y;
    const bool inside_x = level_.window.closed_x || (x >= 0 && x + shape.box.width <= field_.size.width);
    const bool inside_y = level_.window.closed_y || (y >= 0 && y + shape.box.height <= field_.size.height);
    const double least = inside_x && inside_y ? tuning->least_shown : tuning->least_shown_at_border;
    return double(s.blocks) >= least * double(shape.area);
  }

  /// A place of an element that is bent to meet its neighbours: from its centre, in blocks.
  struct Bent {
    double x, y;
  };

  /// Bends along the slope of the depth: at the outline until the element ends half-way between its own outline and its
  /// neighbour's, and the less the deeper inside.
  Bent bent(const ElementShape& shape, const ElementPacking::Place& place, Bent at) const {
    if (place.neighbour <= ElementShape::unknown_depth) return at;
    const double wanted = (double(place.depth) - double(place.neighbour)) / 2;
    const double weight = 1 - wanted / std::max(1.0, tuning->bend_depth * double(shape.inner_radius));
    if (weight <= 0 || std::abs(wanted - double(place.depth)) < tuning->unseen) return at;
    const auto depth = [&](double x, double y) { return shape.depth_between(x, y); };
    const double first = double(place.depth) + weight * (wanted - double(place.depth));
    for (int i = 0; i < tuning->bend_steps; i++) {
      const double off = first - depth(at.x, at.y);
      const double slope_x = depth(at.x + 1, at.y) - depth(at.x - 1, at.y);
      const double slope_y = depth(at.x, at.y + 1) - depth(at.x, at.y - 1);
      const double slope = std::sqrt(slope_x * slope_x + slope_y * slope_y);
      if (std::abs(off) < 0.05 || slope < 0.5 || slope > 8) break;
      const double by = std::clamp(off, -4.0, 4.0) / slope;
      at.x += by * slope_x;
      at.y += by * slope_y;
    }
    return at;
  }

  void show(int column, int row) {
    const ElementPacking::Place& place = packing_.at(column, row);
    if (place.placed < 0) return;
    const PlacedElement& p = packing_.placed()[size_t(place.placed)];
    const ElementShape& shape = shapes_[p.element];
    int x = column - packing_.column_of(p), y = row - packing_.row_of(p);
    if (level_.window.closed_x) x = wrap(x + field_.size.width / 2, field_.size.width) - field_.size.width / 2;
    if (level_.window.closed_y) y = wrap(y + field_.size.height / 2, field_.size.height) - field_.size.height / 2;
    const Bent to = bent(shape, place, {double(x), double(y)});
    // What is not bent keeps its shift, which need not be whole blocks.
    int u = (x + packing_.column_of(p)) * block_ + p.shift_x + int(std::floor((to.x - x) * block_ + 0.5));
    int v = (y + packing_.row_of(p)) * block_ + p.shift_y + int(std::floor((to.y - y) * block_ + 0.5));
    if (wraps_) {
      u = wrap(u, elements_.size.width);
      v = wrap(v, elements_.size.height);
    } else {
      u = std::clamp(u, 0, elements_.size.width - block_);
      v = std::clamp(v, 0, elements_.size.height - block_);
    }
    field_.at(column, row) = {uint16_t(u), uint16_t(v)};
  }

  Field& field_;
  int block_;
  const CorrectionLevel& level_;
  const Elements& elements_;
  bool wraps_;
  ElementShapes shapes_;
  ElementPacking packing_;
};

}  // namespace

bool has_elements(const Appearance& appearance) {
  const ElementsPtr& e = appearance.elements();
  return e && whole_elements(*e, appearance.wraps()) >= tuning->fewest;
}

void lay_elements(Field& field, int block, const CorrectionLevel& level, const Appearance& appearance,
                  const Task& task) {
  ElementLayout layout(field, block, level, appearance);
  layout.lay(task);
}

}  // namespace terrazzo
