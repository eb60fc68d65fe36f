#include "core/synthesis/steps/element_places.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct ElementPlacesTuning {
  double bent = 0.5;
  int same_place = 4;
};
const Tunable<ElementPlacesTuning> element_places_tuning(
    "element_places",
    {
        {&ElementPlacesTuning::bent, "bent", "inner radii",
         "likewise, of large ones. Higher: one that comes twice in part is one; lower: one that is bent is two",
         "element_layout", 0, 2},
        {&ElementPlacesTuning::same_place, "same_place", "pixels", "within which an element is in one place",
         "What each rule decides", 0, 64},
    });

/// Elements and shifts in a fixed order.
using Vote = std::tuple<int, int, int>;

struct Count {
  int64_t blocks = 0, kept = 0;
};

}  // namespace

ElementPlaces::ElementPlaces(const Field& field, const CorrectionLevel& level, const Appearance& appearance)
    : field_(field),
      level_(level),
      elements_(*appearance.elements()),
      wraps_(appearance.wraps()),
      shapes_(element_shapes(elements_, appearance.levels().front().usable, level_.block, wraps_)) {}

PlacedElement ElementPlaces::element_at(int column, int row) const {
  const ExemplarPixel& p = field_.at(column, row);
  const int element = elements_.at[size_t(p.y) * size_t(elements_.size.width) + p.x];
  const ElementShape& shape = shapes_[element];
  const auto unwrapped = [&](int at, int centre, int length) {
    return wraps_ ? centre + nearest_to_zero(at - centre, length) : at;
  };
  return {element, unwrapped(p.x, shape.centre_x * level_.block, elements_.size.width) - column * level_.block,
          unwrapped(p.y, shape.centre_y * level_.block, elements_.size.height) - row * level_.block};
}

std::vector<std::vector<ShownElement>> ElementPlaces::shown() const {
  std::map<Vote, Count> votes;
  auto counted = votes.end();  // mostly that of the block before
  for (int row = 0; row < field_.size.height; row++)
    for (int column = 0; column < field_.size.width; column++) {
      const PlacedElement p = element_at(column, row);
      const Vote vote{p.element, p.shift_x, p.shift_y};
      if (counted == votes.end() || counted->first != vote) counted = votes.try_emplace(vote).first;
      counted->second.blocks++;
      counted->second.kept += level_.is_fixed(column, row);
    }
  std::vector<std::pair<Vote, Count>> by_size(votes.begin(), votes.end());
  std::ranges::stable_sort(by_size, [](const auto& a, const auto& b) { return a.second.blocks > b.second.blocks; });
  std::vector<std::vector<ShownElement>> places(shapes_.all.size());
  for (const auto& [vote, count] : by_size) {
    const auto& [element, shift_x, shift_y] = vote;
    const PlacedElement at{element, shift_x, shift_y};
    std::vector<ShownElement>& of_element = places[size_t(element)];
    const ShownElement* found = find(of_element, at);
    ShownElement& s = found ? of_element[size_t(found - of_element.data())] : of_element.emplace_back(ShownElement{at});
    s.blocks += count.blocks;
    s.kept += count.kept;
  }
  return places;
}

/// An element of a kept result that was bent to meet its neighbours is still in one place.
const ShownElement* ElementPlaces::find(const std::vector<ShownElement>& places, const PlacedElement& at) const {
  const double deep = level_.fixed.any() ? double(shapes_[at.element].inner_radius) * level_.block : 0;
  const int reach = std::max(element_places_tuning->same_place, int(element_places_tuning->bent * deep));
  const auto found = std::ranges::find_if(places, [&](const ShownElement& s) {
    return std::abs(s.placed.shift_x - at.shift_x) <= reach && std::abs(s.placed.shift_y - at.shift_y) <= reach;
  });
  return found == places.end() ? nullptr : &*found;
}

ExemplarPixel ElementPlaces::inside(int x, int y) const {
  if (wraps_) return {uint16_t(wrap(x, elements_.size.width)), uint16_t(wrap(y, elements_.size.height))};
  return {uint16_t(std::clamp(x, 0, elements_.size.width - level_.block)),
          uint16_t(std::clamp(y, 0, elements_.size.height - level_.block))};
}

}  // namespace terrazzo
