#include "core/metrics/long_lines.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "core/base/bounds.h"
#include "core/base/tuning.h"
#include "core/image/line_changes.h"

namespace terrazzo {

namespace {

struct LongLinesTuning {
  double least_share = 0.06;
  double least_kept = 0.62;
};
const Tunable<LongLinesTuning> long_lines_tuning(
    "long_lines",
    {{&LongLinesTuning::least_share, "least_share", "share of all changes",
      "that long lines must hold to be missed. Higher: broken ones pass; lower: scratches and grain count",
      "long_lines", 0, 1},
     {&LongLinesTuning::least_kept, "least_kept", "share of what the exemplar has",
      "below which lines are broken. Higher: good results are doubted; lower: torn ones pass", "long_lines", 0, 1}});

constexpr int most_side = 256;     ///< of the exemplar at which lines are looked at, as by the lattice search
constexpr int most_exemplars = 2;  ///< of the result, along a side

Planes picture(Size size, bool wraps, const std::function<const AppearanceVector&(int, int)>& at) {
  Planes out = Planes::zeros(size, appearance_dimensions, wraps);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) std::ranges::copy(at(x, y), out.at(x, y));
  return out;
}

/// The part of a level that may be shown; empty if it is no rectangle.
Rect shown_part(const AppearanceLevel& level) {
  if (level.usable.empty()) return whole(level.size);
  const Rect box = bounds(level.size, [&](size_t i) { return level.usable[i] != 0; });
  return std::ranges::count(level.usable, 1) == box.area() ? box : Rect{};
}

/// Of the part of a result that is looked at, at the size of that level.
Size seen_size(const UvMap& uv, Size level) {
  const auto side = [](int result, int exemplar, int shown) {
    return int(std::min(int64_t(result), int64_t(most_exemplars) * exemplar) * shown / exemplar);
  };
  return {side(uv.size().width, uv.exemplar().width, level.width),
          side(uv.size().height, uv.exemplar().height, level.height)};
}

Planes picture_of_result(const UvMap& uv, const AppearanceLevel& level) {
  const Size e = uv.exemplar(), l = level.size;
  const auto scaled = [](int at, int from, int to) { return int(int64_t(at) * to / from); };
  return picture(seen_size(uv, l), false, [&](int x, int y) -> const AppearanceVector& {
    const ExemplarPixel p = uv.at(scaled(x, l.width, e.width), scaled(y, l.height, e.height));
    return level
        .vectors[size_t(scaled(p.y, e.height, l.height)) * size_t(l.width) + size_t(scaled(p.x, e.width, l.width))];
  });
}

}  // namespace

bool LongLines::are_broken() const {
  return share >= long_lines_tuning->least_share && kept < long_lines_tuning->least_kept;
}

LongLines long_lines(const UvMap& uv, const Appearance& appearance, const Task& task) {
  const auto small = std::ranges::find_if(
      appearance.levels(), [](const AppearanceLevel& l) { return std::min(l.size.width, l.size.height) <= most_side; });
  const AppearanceLevel& level = small == appearance.levels().end() ? appearance.levels().back() : *small;
  LongLines out;
  const Rect part = shown_part(level);
  const int side = std::min(part.width, part.height);
  const Size seen = seen_size(uv, level.size);
  if (part.empty() || std::min(seen.width, seen.height) < side) return out;
  const Planes exemplar =
      picture({part.width, part.height}, appearance.wraps(), [&](int x, int y) -> const AppearanceVector& {
        return level.vectors[size_t(part.y + y) * size_t(level.size.width) + size_t(part.x + x)];
      });
  std::optional<Planes> result;  // only where lines could be missed
  std::array<LineChanges, 2> own;
  for (const bool rows : {true, false}) own[rows] = line_changes(exemplar, rows, side, task);
  const double all = own[0].single + own[1].single;
  for (const bool rows : {true, false}) {
    LongLines l{all > 0 ? own[rows].lasting / all : 0, 1};
    if (l.share >= long_lines_tuning->least_share) {
      if (!result) result = picture_of_result(uv, level);
      const LineChanges shown = line_changes(*result, rows, side, task);
      if (shown.brief > 0) l.kept = shown.lasting / own[rows].lasting * own[rows].brief / shown.brief;
    }
    if (l.are_broken() ? !out.are_broken() || l.kept < out.kept : !out.are_broken() && l.share > out.share) out = l;
  }
  return out;
}

}  // namespace terrazzo
