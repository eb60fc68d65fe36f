#include "core/metrics/layout.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "core/base/portable_math.h"
#include "core/metrics/copies.h"

namespace terrazzo {

namespace {

/// The seams of one row.
struct Seams {
  int64_t pairs = 0;
  int64_t cut = 0;
  double difference = 0;
};

class SeamFinder {
 public:
  SeamFinder(const UvMap& layout, const Planes& exemplar, bool wraps)
      : layout_(layout), exemplar_(exemplar), wraps_(wraps) {}

  Seams row(int y) const {
    Seams out;
    for (int x = 0; x < layout_.size().width; x++) {
      if (x + 1 < layout_.size().width) add(layout_.at(x, y), layout_.at(x + 1, y), 1, 0, out);
      if (y + 1 < layout_.size().height) add(layout_.at(x, y), layout_.at(x, y + 1), 0, 1, out);
    }
    return out;
  }

 private:
  void add(ExemplarPixel a, ExemplarPixel b, int dx, int dy, Seams& out) const {
    out.pairs++;
    const ExemplarPixel after = moved(a, dx, dy);
    const bool inside = wraps_ || (a.x + dx < exemplar_.size.width && a.y + dy < exemplar_.size.height);
    if (inside && after == b) return;
    out.cut++;
    out.difference += (difference(after, b) + difference(moved(b, -dx, -dy), a)) / 2;
  }
  ExemplarPixel moved(ExemplarPixel p, int dx, int dy) const {
    const auto place = [this](int v, int n) { return uint16_t(wraps_ ? wrap(v, n) : std::clamp(v, 0, n - 1)); };
    return {place(p.x + dx, exemplar_.size.width), place(p.y + dy, exemplar_.size.height)};
  }
  double difference(ExemplarPixel a, ExemplarPixel b) const {
    const float *p = exemplar_.at(a.x, a.y), *q = exemplar_.at(b.x, b.y);
    double sum = 0;
    for (int k = 0; k < exemplar_.channels; k++) sum += double(p[k] - q[k]) * (p[k] - q[k]);
    return std::sqrt(sum / exemplar_.channels);
  }

  const UvMap& layout_;
  const Planes& exemplar_;
  bool wraps_;
};

double usage_entropy(const UvMap& layout) {
  const Size exemplar = layout.exemplar();
  const int across = std::min(16, exemplar.width), down = std::min(16, exemplar.height);
  std::vector<int64_t> use(size_t(across) * down);
  for (const ExemplarPixel p : layout.pixels())
    use[size_t(int64_t{p.y} * down / exemplar.height) * across + size_t(int64_t{p.x} * across / exemplar.width)]++;
  const double total = double(layout.size().area()), most = std::min(double(use.size()), total);
  double entropy = 0;
  for (const int64_t n : use)
    if (n > 0) entropy -= double(n) / total * portable::log(double(n) / total);
  return most > 1 ? entropy / portable::log(most) : 1;
}

std::vector<Shift> shifts_of(const UvMap& layout, bool wraps) {
  std::vector<Shift> out;
  out.reserve(layout.pixels().size());
  for (int y = 0; y < layout.size().height; y++)
    for (int x = 0; x < layout.size().width; x++) {
      const ExemplarPixel p = layout.at(x, y);
      const Shift shift{p.x - x, p.y - y};
      out.push_back(wraps ? Shift{wrap(shift.x, layout.exemplar().width), wrap(shift.y, layout.exemplar().height)}
                          : shift);
    }
  return out;
}

}  // namespace

LayoutFigures layout_figures(const UvMap& layout, const Planes& exemplar, bool wraps) {
  const Planes at_size = resampled(exemplar, layout.exemplar());
  const SeamFinder finder(layout, at_size, wraps);
  std::vector<Seams> rows(layout.size().height);
  tbb::parallel_for(0, layout.size().height, [&](int y) { rows[y] = finder.row(y); });
  Seams all;
  for (const Seams& r : rows) {
    all.pairs += r.pairs;
    all.cut += r.cut;
    all.difference += r.difference;
  }
  LayoutFigures out;
  const double pairs = double(std::max<int64_t>(1, all.pairs));
  out.seam_share = double(all.cut) / pairs;
  out.seam_difference = all.cut > 0 ? all.difference / double(all.cut) : 0;
  out.seam_energy = all.difference / pairs;
  out.usage_entropy = usage_entropy(layout);
  const CopiedRegions copies = copied_regions(layout.size(), shifts_of(layout, wraps));
  const double area = double(layout.exemplar().area());
  out.verbatim = copies.typical_side / std::sqrt(area);
  out.largest_copy = copies.largest_area / area;
  return out;
}

}  // namespace terrazzo
