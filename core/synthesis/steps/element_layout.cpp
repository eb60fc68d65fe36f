#include "core/synthesis/steps/element_layout.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <tbb/parallel_for.h>

#include "core/base/tuning.h"
#include "core/synthesis/steps/element_packing.h"
#include "core/synthesis/steps/element_shapes.h"
#include "core/synthesis/steps/element_warp.h"

namespace terrazzo {

namespace {

struct Tuning {
  double least_shown = 0.4;
  double least_shown_at_border = 0.15;
  double least_kept = 0.03;
  double bent = 0.5;
  int same_place = 4;
  int fewest = 4;
};
const Tunable<Tuning> tuning(
    "element_layout",
    {
        {&Tuning::least_shown, "least_shown", "of an element",
         "that the field must show for it to stay. Higher: more is laid anew; lower: what stays fits less",
         "element_layout", 0, 1},
        {&Tuning::least_shown_at_border, "least_shown_at_border", "of an element",
         "the same where the result's border cuts it", "not measured: chosen by eye", 0, 1},
        {&Tuning::least_kept, "least_kept", "of an element",
         "that must be kept for all of it to be shown. Higher: more is cut where kept pixels end; lower: crumbs count",
         "not measured: chosen by eye", 0, 1},
        {&Tuning::same_place, "same_place", "pixels", "within which an element is in one place",
         "not measured: seams jog by less", 0, 64},
        {&Tuning::bent, "bent", "inner radii",
         "likewise, of large ones. Higher: one that comes twice in part is one; lower: one that is bent is two",
         "element_layout", 0, 2},
        {&Tuning::fewest, "fewest", "elements",
         "that an exemplar must have whole. Higher: large tiles keep to their lattice; lower: they come back and back",
         "not measured: fewer are no choice", 1},
    });

/// Where an element of the exemplar lies when it is shown with a shift.
struct Vote {
  int element, shift_x, shift_y;
  auto operator<=>(const Vote&) const = default;
};

class ElementLayout {
 public:
  ElementLayout(Field& field, int block, const CorrectionLevel& level, const Appearance& appearance,
                const Lattice* lattice)
      : field_(field),
        block_(block),
        level_(level),
        elements_(*appearance.elements()),
        wraps_(appearance.wraps()),
        lattice_(lattice),
        shapes_(element_shapes(elements_, appearance.levels().front().usable, block, wraps_)),
        packing_(shapes_, field.size, level.window.closed_x, level.window.closed_y) {}

  void lay(const Task& task) {
    const Places places = shown();
    std::vector<PlacedElement> placed;
    for (const auto& of_element : places)
      for (const Shown& s : of_element)
        if (s.placed.stays || (is_shown(s) && is_in_phase(s.placed))) placed.push_back(s.placed);
    if (lattice_) packing_.keep_to(*lattice_, level_.phase);
    if (level_.fixed.any()) packing_.keep_off(kept_without(places));
    packing_.pack(std::move(placed), task);
    warps_.resize(packing_.placed().size());
    tbb::parallel_for(0, int(warps_.size()), [&](int i) { warps_[size_t(i)] = ElementWarp(shapes_, packing_, i); });
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
    int64_t kept = 0;  ///< of them, those that are kept
  };
  using Places = std::vector<std::vector<Shown>>;  // of each element

  bool is_kept(int column, int row) const { return level_.fixed.at(level_.window.index(column, row)); }

  /// What the field shows of elements, and where.
  Places shown() const {
    struct Count {
      int64_t blocks = 0, kept = 0;
    };
    std::map<Vote, Count> votes;
    for (int row = 0; row < field_.size.height; row++)
      for (int column = 0; column < field_.size.width; column++) {
        Count& count = votes[vote_of(column, row)];
        count.blocks++;
        count.kept += is_kept(column, row);
      }
    std::vector<std::pair<Vote, Count>> by_size(votes.begin(), votes.end());
    std::ranges::stable_sort(by_size, [](const auto& a, const auto& b) { return a.second.blocks > b.second.blocks; });
    Places places(shapes_.all.size());
    for (const auto& [vote, count] : by_size) {
      Shown& s = place_of(places[size_t(vote.element)], vote);
      s.blocks += count.blocks;
      s.kept += count.kept;
    }
    for (auto& of_element : places)
      for (Shown& s : of_element) s.placed.stays = is_continued(s);
    return places;
  }

  /// An element of a kept result that was bent to meet its neighbours is still in one place.
  const Shown* find_place(const std::vector<Shown>& places, const Vote& vote) const {
    const double deep = level_.fixed.any() ? double(shapes_[vote.element].inner_radius) * block_ : 0;
    const int reach = std::max(tuning->same_place, int(tuning->bent * deep));
    const auto at = std::ranges::find_if(places, [&](const Shown& s) {
      return std::abs(s.placed.shift_x - vote.shift_x) <= reach && std::abs(s.placed.shift_y - vote.shift_y) <= reach;
    });
    return at == places.end() ? nullptr : &*at;
  }

  Shown& place_of(std::vector<Shown>& places, const Vote& vote) const {
    if (const Shown* s = find_place(places, vote)) return places[size_t(s - places.data())];
    return places.emplace_back(Shown{{vote.element, vote.shift_x, vote.shift_y}});
  }

  /// Whether an element that is partly kept goes on beyond that.
  bool is_continued(const Shown& s) const {
    const ElementShape& shape = shapes_[s.placed.element];
    return !shape.unusable && s.kept > 0 && double(s.kept) >= tuning->least_kept * double(shape.area);
  }

  /// The kept blocks that show none of the elements that go on.
  std::vector<uint8_t> kept_without(const Places& places) const {
    std::vector<uint8_t> out(field_.pixels.size());
    for (int row = 0; row < field_.size.height; row++)
      for (int column = 0; column < field_.size.width; column++) {
        if (!is_kept(column, row)) continue;
        const Vote vote = vote_of(column, row);
        const Shown* s = find_place(places[size_t(vote.element)], vote);
        out[size_t(row) * size_t(field_.size.width) + size_t(column)] = !s || !s->placed.stays;
      }
    return out;
  }

  /// Whether an element lies where the lattice that it keeps to has it, give or take seams.
  bool is_in_phase(const PlacedElement& p) const {
    if (!lattice_) return true;
    const int x = packing_.column_of(p) * block_, y = packing_.row_of(p) * block_;
    int u = x + p.shift_x, v = y + p.shift_y;
    level_.phase.snap(x, y, u, v);
    return std::max(std::abs(u - x - p.shift_x), std::abs(v - y - p.shift_y)) <= tuning->same_place / 2;
  }

  /// Whether the field shows an element for the most part.
  bool is_shown(const Shown& s) const {
    const ElementShape& shape = shapes_[s.placed.element];
    if (shape.unusable) return false;
    const int x = packing_.column_of(s.placed) + shape.box.x, y = packing_.row_of(s.placed) + shape.box.y;
    const bool inside_x = level_.window.closed_x || (x >= 0 && x + shape.box.width <= field_.size.width);
    const bool inside_y = level_.window.closed_y || (y >= 0 && y + shape.box.height <= field_.size.height);
    const double least = inside_x && inside_y ? tuning->least_shown : tuning->least_shown_at_border;
    return double(s.blocks) >= least * double(shape.area);
  }

  void show(int column, int row) {
    const ElementPacking::Place& place = packing_.at(column, row);
    if (place.placed < 0 || is_kept(column, row)) return;
    const PlacedElement& p = packing_.placed()[size_t(place.placed)];
    int x = column - packing_.column_of(p), y = row - packing_.row_of(p);
    if (level_.window.closed_x) x = wrap(x + field_.size.width / 2, field_.size.width) - field_.size.width / 2;
    if (level_.window.closed_y) y = wrap(y + field_.size.height / 2, field_.size.height) - field_.size.height / 2;
    const ElementWarp::At to = warps_[size_t(place.placed)]({double(x), double(y)});
    // What is not moved keeps its shift, which need not be whole blocks.
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
  const Lattice* lattice_;
  ElementShapes shapes_;
  ElementPacking packing_;
  std::vector<ElementWarp> warps_;  // of each placed element
};

}  // namespace

bool has_elements(const Appearance& appearance) {
  const ElementsPtr& e = appearance.elements();
  return e && whole_elements(*e, appearance.wraps()) >= tuning->fewest;
}

void lay_elements(Field& field, int block, const CorrectionLevel& level, const Appearance& appearance,
                  const Lattice* lattice, const Task& task) {
  ElementLayout layout(field, block, level, appearance, lattice);
  layout.lay(task);
}

}  // namespace terrazzo
