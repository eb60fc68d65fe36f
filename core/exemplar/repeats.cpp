#include "core/exemplar/repeats.h"

namespace terrazzo {

namespace {

int beyond(int v, int first, int end) {
  return std::max({0, first - v, v - end + 1});
}

/// The part a position lies in or next to.
size_t nearest_part(const std::vector<LatticePart>& parts, int x, int y) {
  const auto distance = [&](const Rect& r) {
    const int64_t dx = beyond(x, r.x, r.right()), dy = beyond(y, r.y, r.bottom());
    return dx * dx + dy * dy;
  };
  return size_t(std::ranges::min_element(parts, {}, [&](const LatticePart& p) { return distance(p.place); }) -
                parts.begin());
}

/// For every pixel of a level which part its middle lies in or next to.
std::vector<uint8_t> part_at_each(const std::vector<LatticePart>& parts, Size size, int level) {
  constexpr uint8_t unknown = 255;
  static_assert(most_lattice_parts <= unknown);
  std::vector<uint8_t> out(size_t(size.area()), unknown);
  const int middle = (1 << level) / 2;
  const auto first_from = [&](int edge) { return (std::max(0, edge - middle) + (1 << level) - 1) >> level; };
  for (size_t i = 0; i < parts.size(); i++) {
    const Rect& place = parts[i].place;
    const int left = first_from(place.x), right = std::min(size.width, first_from(place.right()));
    for (int y = first_from(place.y); y < std::min(size.height, first_from(place.bottom())); y++)
      std::fill_n(out.begin() + ptrdiff_t(size_t(y) * size.width + left), std::max(0, right - left), uint8_t(i));
  }
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      if (uint8_t& part = out[size_t(y) * size.width + x]; part == unknown)
        part = uint8_t(nearest_part(parts, (x << level) + middle, (y << level) + middle));
  return out;
}

}  // namespace

Repeats::Repeats(std::vector<LatticePart> several) : parts(std::move(several)) {
  int64_t largest = -1;
  for (const LatticePart& p : parts) {
    const int64_t area = p.lattice.rank > 0 ? p.place.area() : 0;
    if (area > largest) lattice = p.shown;
    largest = std::max(largest, area);
  }
}

void Repeats::add_to(Hasher& h) const {
  lattice.add_to(h);
  if (streaks.any()) h.add("streaks").add(streaks.x).add(streaks.y);
  if (parts.empty()) return;
  h.add(int64_t(parts.size()));
  for (const LatticePart& p : parts) {
    h.add(p.place.x).add(p.place.y).add(p.place.width).add(p.place.height);
    p.lattice.add_to(h);
    p.shown.add_to(h);
    h.add(p.start.x()).add(p.start.y());
  }
}

PartPhases::PartPhases(const Repeats& repeats, Size exemplar, int level, const LatticeSurface& surface)
    : size_(exemplar) {
  if (repeats.parts.empty()) {
    one_ = {repeats.lattice, level, surface};
    active_ = one_.active();
    resolves_cells_ = one_.resolves_cells();
    whole_ = one_.is_whole();
    return;
  }
  std::vector<LatticePhase> phases;
  for (const LatticePart& p : repeats.parts) phases.emplace_back(p.lattice, p.shown, p.start, level, surface);
  const auto is_active = [](const LatticePhase& p) { return p.active(); };
  active_ = std::ranges::any_of(phases, is_active);
  resolves_cells_ =
      active_ && std::ranges::all_of(phases, [](const LatticePhase& p) { return !p.active() || p.resolves_cells(); });
  whole_ = active_ && std::ranges::all_of(phases, [](const LatticePhase& p) { return !p.active() || p.is_whole(); });
  parts_ = std::make_shared<const std::vector<LatticePhase>>(std::move(phases));
  part_at_ = std::make_shared<const std::vector<uint8_t>>(part_at_each(repeats.parts, exemplar, level));
}

}  // namespace terrazzo
