#include "core/synthesis/steps/element_packing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include <tbb/parallel_for.h>

#include "core/base/geometry.h"
#include "core/base/tuning.h"
#include "core/numeric/distance_transform.h"
#include "core/synthesis/steps/element_holes.h"

namespace terrazzo {

namespace {

struct PackTuning {
  double least_clear = 0.7;
  double soft = 0.12;
  double tolerance = 0.04;
  double hole = 0.1;
  double farthest_filled = 2;
  double overlap = 2;
  double least_overlap = 0.6;
  double least_gain = 0.35;
  double seen_around = 0.15;
  double around = 6;
  double used = 0.08;
  double step = 0.24;
  double contact = 0.3;
  double contact_within = 0.08;
  double farthest_moved = 0.2;
  double worth_moving = 0.02;
  int settling = 4;
  int rounds = 7;
};
const Tunable<PackTuning> pack_tuning(
    "element_packing",
    {
        {&PackTuning::least_clear, "least_clear", "of an element",
         "that no other covers, or it goes. Higher: stones stay whole; lower: fewer go", "element_layout", 0, 1},
        {&PackTuning::soft, "soft", "typical sides",
         "of overlap at which it costs its full price. Higher: more is squeezed", "element_layout", 0.001, 4},
        {&PackTuning::tolerance, "tolerance", "typical sides", "of a gap that is no hole yet", "element_layout", 0, 4},
        {&PackTuning::hole, "hole", "typical sides", "the least radius of holes. Lower: smaller ones are filled, too",
         "element_layout", 0.001, 4},
        {&PackTuning::farthest_filled, "farthest_filled", "typical sides",
         "up to which holes are told by their size. Costs time and memory", "What each rule decides", 0.1, 100},
        {&PackTuning::overlap, "overlap", "times the gain of as much hole",
         "what it costs to cover others. Higher: gaps stay; lower: elements are squeezed", "element_layout", 0, 100},
        {&PackTuning::least_overlap, "least_overlap", "times the gain of as much hole",
         "the same where nothing else fits", "element_layout", 0, 100},
        {&PackTuning::least_gain, "least_gain", "of an element's area",
         "what an element must fill, less what it covers. Higher: gaps stay; lower: elements are squeezed",
         "element_layout", 0, 1},
        {&PackTuning::seen_around, "seen_around", "of an element's area",
         "the price of one of the same right beside it. Higher: less repeats; lower: what is there fits better",
         "element_layout", 0, 100},
        {&PackTuning::around, "around", "typical sides", "as far as that counts", "element_layout", 0.1, 100},
        {&PackTuning::used, "used", "of an element's area",
         "the price of being used twice as often as others. Higher: all elements come about as often", "element_layout",
         0, 100},
        {&PackTuning::step, "step", "typical sides", "between places that are tried. Lower: better fits; costs time",
         "element_layout", 0.01, 4},
        {&PackTuning::contact, "contact", "of an element's area",
         "what it is worth to end where all neighbours begin. Higher: neighbours meet; lower: holes are filled",
         "element_layout", 0, 100},
        {&PackTuning::contact_within, "contact_within", "typical sides",
         "by which they may miss each other. Higher: near misses count as well", "element_layout", 0.001, 4},
        {&PackTuning::farthest_moved, "farthest_moved", "typical sides",
         "that an element moves at a time to meet its neighbours", "element_layout", 0, 4},
        {&PackTuning::worth_moving, "worth_moving", "of an element's area",
         "by which it must fit better elsewhere. Higher: elements stay; lower: they creep for nothing",
         "What each rule decides", 0, 1},
        {&PackTuning::settling, "settling", "rounds", "of moving elements. Costs time", "element_layout", 0, 100},
        {&PackTuning::rounds, "rounds", "rounds", "of taking away and filling. Costs time", "element_layout", 1, 100},
    });

constexpr float farthest = 1e6f;  // of what is kept, where nothing is

/// By how many columns and rows elements move at a time.
std::array<std::pair<int, int>, 4> moves(int reach) {
  return {{{reach, 0}, {-reach, 0}, {0, reach}, {0, -reach}}};
}

}  // namespace

ElementPacking::ElementPacking(const ElementShapes& shapes, const Plane& plane)
    : shapes_(shapes), plane_(plane), tolerance_(pack_tuning->tolerance * shapes.typical_side) {
  for (int e = 0; e < int(shapes.all.size()); e++)
    if (!shapes[e].unusable && !shapes[e].samples.empty()) largest_first_.push_back(e);
  std::ranges::stable_sort(largest_first_, std::ranges::greater{}, [&](int e) { return shapes[e].area; });
}

void ElementPacking::keep_off(const std::vector<uint8_t>& blocks) {
  kept_depth_ = signed_distances(blocks, plane_.size, plane_.tile_x && plane_.tile_y, farthest);
  for (float& d : kept_depth_) d = -d;
}

/// Calls visit(index, depth) for the blocks of an element's box that the result has.
template <typename Visit>
void ElementPacking::for_blocks(const PlacedElement& p, Visit visit) const {
  const ElementShape& shape = shapes_[p.element];
  const int left = shapes_.column_of(p) + shape.box.x, top = shapes_.row_of(p) + shape.box.y;
  const float* depth = shape.depths.data();
  for (int y = 0; y < shape.box.height; y++)
    for (int x = 0; x < shape.box.width; x++, depth++)
      if (const int64_t i = plane_.index(left + x, top + y); i >= 0) visit(size_t(i), *depth);
}

void ElementPacking::paint(size_t placed) {
  for_blocks(placed_[placed], [&](size_t i, float depth) {
    Place& p = places_[i];
    if (depth > p.depth.blocks()) {
      p.neighbour = p.depth;
      p.depth = Depth(depth);
      p.placed = int(placed);
    } else {
      p.neighbour = Depth(std::max(p.neighbour.blocks(), depth));
    }
  });
}

void ElementPacking::paint_all() {
  places_.assign(size_t(plane_.size.area()),
                 {-1, Depth(ElementShape::unknown_depth), Depth(ElementShape::unknown_depth)});
  for (size_t i = 0; i < kept_depth_.size(); i++) places_[i].depth = Depth(kept_depth_[i]);
  of_element_.assign(shapes_.all.size(), {});
  for (size_t i = 0; i < placed_.size(); i++) {
    paint(i);
    of_element_[size_t(placed_[i].element)].push_back(i);
  }
}

void ElementPacking::measure_clear() {
  tbb::parallel_for(0, int(placed_.size()), [&](int i) {
    int64_t clear = 0, all = 0;
    for_blocks(placed_[size_t(i)], [&](size_t at, float depth) {
      if (depth <= 0) return;
      all++;
      clear += places_[at].placed == i && places_[at].neighbour.blocks() <= 0;
    });
    placed_[size_t(i)].clear = all > 0 ? double(clear) / double(all) : 0;
  });
}

/// The most covered first, and none of its neighbours along with it: they are seen more once it is gone.
void ElementPacking::remove_overlapped(const Task& task) {
  for (int round = 0; round < pack_tuning->rounds; round++) {
    task.check();
    measure_clear();
    std::vector<size_t> covered;
    for (size_t i = 0; i < placed_.size(); i++)
      if (!placed_[i].stays && placed_[i].clear < pack_tuning->least_clear) covered.push_back(i);
    if (covered.empty()) return;
    std::ranges::stable_sort(covered, {}, [&](size_t i) { return placed_[i].clear; });
    std::vector<uint8_t> stays(placed_.size(), 0), goes(placed_.size(), 0);
    for (const size_t i : covered) {
      if (stays[i]) continue;
      goes[i] = 1;
      for_blocks(placed_[i], [&](size_t at, float depth) {
        if (depth > 0 && places_[at].placed >= 0 && places_[at].placed != int(i)) stays[size_t(places_[at].placed)] = 1;
      });
    }
    std::vector<PlacedElement> left;
    for (size_t i = 0; i < placed_.size(); i++)
      if (!goes[i]) left.push_back(placed_[i]);
    placed_ = std::move(left);
    paint_all();
  }
}

/// The middles of holes, the largest first.
std::vector<Hole> ElementPacking::holes() const {
  std::vector<uint8_t> filled(places_.size());
  std::ranges::transform(places_, filled.begin(), [&](const Place& p) { return uint8_t(is_filled(p)); });
  const double least = std::max(1.0, pack_tuning->hole * shapes_.typical_side);
  return find_holes(filled, plane_, least, int(pack_tuning->farthest_filled * shapes_.typical_side) + 1);
}

/// How often an element is seen around a place, the nearer the more.
double ElementPacking::seen_around(int element, int column, int row) const {
  const double reach = pack_tuning->around * shapes_.typical_side;
  double sum = 0;
  for (const size_t i : of_element_[size_t(element)]) {
    int x = std::abs(shapes_.column_of(placed_[i]) - column), y = std::abs(shapes_.row_of(placed_[i]) - row);
    if (plane_.tile_x) x = std::abs(nearest_to_zero(x, plane_.size.width));
    if (plane_.tile_y) y = std::abs(nearest_to_zero(y, plane_.size.height));
    sum += std::max(0.0, 1 - std::sqrt(double(x) * x + double(y) * y) / reach);
  }
  return sum;
}

double ElementPacking::Fit::value() const {
  return gain + pack_tuning->contact * contact;
}

/// Its centre at a place; `but`: as if that placed element were not there. Nothing as soon as it is clear that it fits
/// too little or its value does not exceed `least`.
std::optional<ElementPacking::Fit> ElementPacking::fit(const ElementShape& shape, int column, int row,
                                                       const FitThresholds& terms, double least, int but) const {
  const double soft = pack_tuning->soft * shapes_.typical_side;
  double gain = 0, left = double(shape.samples.size());
  const double least_sum = std::max(terms.least_gain, least - pack_tuning->contact) * left;
  for (const ElementSample& s : shape.samples) {
    if (gain + left < least_sum) return std::nullopt;
    left--;
    const int64_t i = plane_.index(column + s.x, row + s.y);
    if (i < 0) continue;
    const float there = depth_but(places_[size_t(i)], but);
    gain += there < 0 ? 1 : -terms.overlap * std::min(1.0, double(std::min(there, s.depth)) / soft);
  }
  Fit out{.gain = gain / double(shape.samples.size())};
  const double within = std::max(1.0, pack_tuning->contact_within * shapes_.typical_side);
  double contact = 0;
  int inside = 0;
  for (const ElementSample& s : shape.outline) {
    const int64_t i = plane_.index(column + s.x, row + s.y);
    if (i < 0) continue;
    inside++;
    contact += std::max(0.0, 1 - std::abs(double(depth_but(places_[size_t(i)], but) + s.depth)) / within);
  }
  if (inside > 0) out.contact = contact / inside;
  if (out.gain < terms.least_gain || out.value() <= least) return std::nullopt;
  return out;
}

int ElementPacking::step() const {
  return std::max(1, int(pack_tuning->step * shapes_.typical_side));
}

/// Calls visit(column, row) with places for an element's centre around a hole.
template <typename Visit>
void ElementPacking::for_places(const ElementShape& shape, const Hole& hole, Visit visit) const {
  const int off = int(pack_tuning->step * 4 * shapes_.typical_side);
  const int across = std::max(0, shape.box.width / 2 - off), down = std::max(0, shape.box.height / 2 - off);
  for (int y = -down; y <= down; y += step())
    for (int x = -across; x <= across; x += step()) visit(hole.column + x, hole.row + y);
}

bool ElementPacking::fill(const Hole& hole, const FitThresholds& terms) {
  const double usual = double(placed_.size()) / std::max(1, shapes_.whole);
  struct Best {
    int element = -1, column = 0, row = 0;
    Fit fit{};
    double value = -1e9;
  } best;
  for (const int e : largest_first_) {
    const ElementShape& shape = shapes_[e];
    const double often = std::max(0.0, double(of_element_[size_t(e)].size()) / std::max(1.0, usual) - 1);
    const double price =
        pack_tuning->seen_around * seen_around(e, hole.column, hole.row) + pack_tuning->used * often * often;
    const auto weight = double(shape.area);
    const double most = 1 + pack_tuning->contact - price;
    if (most <= 0 || most * weight <= best.value) continue;
    for_places(shape, hole, [&](int column, int row) {
      if (const std::optional<Fit> f = fit(shape, column, row, terms, best.value / weight + price))
        best = {e, column, row, *f, (f->value() - price) * weight};
    });
  }
  if (best.element < 0) return false;
  const ElementShape& shape = shapes_[best.element];
  for (int reach = step() / 2; reach > 0; reach /= 2)
    for (bool moved = true; moved;) {
      moved = false;
      for (const auto& [x, y] : moves(reach))
        if (const std::optional<Fit> f = fit(shape, best.column + x, best.row + y, terms, best.fit.value() + 1e-9)) {
          best = {best.element, best.column + x, best.row + y, *f, best.value};
          moved = true;
        }
    }
  PlacedElement placed{best.element};
  placed.shift_x = (shape.centre_x - best.column) * shapes_.block;
  placed.shift_y = (shape.centre_y - best.row) * shapes_.block;
  of_element_[size_t(best.element)].push_back(placed_.size());
  placed_.push_back(placed);
  paint(placed_.size() - 1);
  return true;
}

/// Elements move to where they meet their neighbours, all at once, half the way each, for those move as well.
void ElementPacking::settle(const Task& task) {
  const FitThresholds any{-1e9, pack_tuning->overlap};
  const int farthest = std::max(1, int(pack_tuning->farthest_moved * shapes_.typical_side));
  for (int round = 0; round < pack_tuning->settling; round++) {
    task.check();
    std::vector<PlacedElement> moved = placed_;
    tbb::parallel_for(0, int(placed_.size()), [&](int n) {
      const auto i = size_t(n);
      const ElementShape& shape = shapes_[placed_[i].element];
      if (placed_[i].stays || shape.samples.empty()) return;
      const int column = shapes_.column_of(placed_[i]), row = shapes_.row_of(placed_[i]);
      int x = 0, y = 0;
      double best = -1e9;
      const auto move = [&](int dx, int dy) {
        const std::optional<Fit> f = fit(shape, column + x + dx, row + y + dy, any, best, n);
        if (!f) return;
        best = f->value();
        x += dx;
        y += dy;
      };
      move(0, 0);
      const double least = best + pack_tuning->worth_moving;
      for (int reach = farthest; reach > 0; reach /= 2)
        for (const auto& [dx, dy] : moves(reach)) move(dx, dy);
      if (best < least) return;
      moved[i].shift_x -= (x + (x > 0 ? 1 : 0)) / 2 * shapes_.block;
      moved[i].shift_y -= (y + (y > 0 ? 1 : 0)) / 2 * shapes_.block;
    });
    if (moved == placed_) return;
    placed_ = std::move(moved);
    paint_all();
  }
}

int ElementPacking::fill_holes(const FitThresholds& terms, const Task& task) {
  const int off = std::max(1, int(pack_tuning->hole * 2 * shapes_.typical_side));
  std::vector<uint8_t> tried(places_.size(), 0);
  int filled = 0;
  for (const Hole& h : holes()) {
    const auto at = size_t(plane_.index(h.column, h.row));
    if (tried[at] || is_filled(places_[at])) continue;
    task.check();
    if (fill(h, terms)) filled++;
    for (int y = -off; y <= off; y++)
      for (int x = -off; x <= off; x++)
        if (const int64_t i = plane_.index(h.column + x, h.row + y); i >= 0) tried[size_t(i)] = 1;
  }
  return filled;
}

void ElementPacking::pack(std::vector<PlacedElement> placed, const Task& task) {
  placed_ = std::move(placed);
  paint_all();
  for (int round = 0; round < pack_tuning->rounds; round++) {
    task.progress(double(round) / pack_tuning->rounds);
    remove_overlapped(task);
    // What is left is filled with what disturbs least.
    const double part = std::max(0.0, 1 - round / 3.0);
    const FitThresholds terms{part * pack_tuning->least_gain,
                              pack_tuning->least_overlap + part * (pack_tuning->overlap - pack_tuning->least_overlap)};
    if (fill_holes(terms, task) == 0 && part == 0) break;
    settle(task);
  }
  remove_overlapped(task);
  fill_holes({0, pack_tuning->least_overlap}, task);
}

}  // namespace terrazzo
