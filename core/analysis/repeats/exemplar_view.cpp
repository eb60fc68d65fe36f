#include "core/analysis/repeats/exemplar_view.h"

#include <algorithm>

#include "core/base/bounds.h"

namespace terrazzo {

namespace {

// Periods are found to a fraction of a pixel; less than the smallest side has no room for repeats.
constexpr int most_side = 256, smallest_side = 16;

Rect allowed_within(const std::vector<uint8_t>& allowed, Size exemplar, const Rect& part) {
  const auto index = [&](size_t i) {
    return size_t(part.y + int(i / size_t(part.width))) * size_t(exemplar.width) + part.x + i % size_t(part.width);
  };
  const Rect inside = bounds({part.width, part.height}, [&](size_t i) { return allowed[index(i)] != 0; });
  return {part.x + inside.x, part.y + inside.y, inside.width, inside.height};
}

bool is_large(const Planes& planes) {
  const auto [least, most] = std::minmax(planes.size.width, planes.size.height);
  return least >= smallest_side && most > most_side;
}

/// `planes`: the view's before.
void halve(ExemplarView& view, const Planes& planes) {
  view.planes = halved(planes);
  if (!view.counts.values.empty()) view.counts = halved(view.counts);
  view.scale *= 2;
}

}  // namespace

bool ExemplarView::empty() const {
  return std::min(planes.size.width, planes.size.height) < smallest_side;
}

ExemplarView view_of(const Planes& exemplar, const std::vector<uint8_t>& allowed, const Rect& part) {
  ExemplarView view{part, {}, {}};
  if (!allowed.empty()) {
    view.seen = allowed_within(allowed, exemplar.size, part);
    view.counts = cropped({exemplar.size, 1, exemplar.wraps, {allowed.begin(), allowed.end()}}, view.seen);
    if (std::ranges::all_of(view.counts.values, [](float v) { return v == 1; })) view.counts = {};
  }
  if (view.seen == whole(exemplar.size) && is_large(exemplar))
    halve(view, exemplar);
  else
    view.planes = cropped(exemplar, view.seen);
  while (is_large(view.planes)) halve(view, view.planes);
  return view;
}

std::vector<ExemplarView> views_at_one_scale(const Planes& exemplar, const std::vector<uint8_t>& allowed,
                                             const std::vector<Rect>& parts) {
  std::vector<ExemplarView> views;
  double scale = 1;
  for (const Rect& part : parts) {
    views.push_back(view_of(exemplar, allowed, part));
    scale = std::max(scale, views.back().scale);
  }
  for (ExemplarView& view : views)
    while (!view.empty() && view.scale < scale) halve(view, view.planes);
  return views;
}

}  // namespace terrazzo
