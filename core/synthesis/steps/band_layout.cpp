#include "core/synthesis/steps/band_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/base/hash.h"
#include "core/synthesis/state/span_order.h"

namespace terrazzo {

namespace {

class BandLayout {
 public:
  BandLayout(Field& field, const CorrectionLevel& level, const Appearance& appearance, const ElementCourses& courses,
             uint64_t bits)
      : field_(field), level_(level), looks_(appearance.levels().front()), courses_(courses), bits_(bits) {
    const Size exemplar = level.exemplar.size();
    along_ = line(exemplar.width, exemplar.height, field.size.width, field.size.height, level.window.closed_x,
                  level.window.closed_y);
    across_ = line(exemplar.height, exemplar.width, field.size.height, field.size.width, level.window.closed_y,
                   level.window.closed_x);
  }

  void lay(const std::vector<ShownSpan>& bands, const Task& task) {
    Course before;
    for (size_t i = 0; i < bands.size(); i++) {
      task.check();
      Course course = course_of(bands[i], i, before);
      show(bands[i], course);
      for (const ShownSpan& piece : course.pieces) used_[course.name_of(piece)]++;
      before = std::move(course);
      task.progress(double(i + 1) / double(bands.size()));
    }
  }

 private:
  struct Course {
    CoursePieces pool;
    std::vector<ShownSpan> pieces;

    const ExemplarSpan& band_of(const ShownSpan& piece) const { return pool.bands[size_t(piece.number)]; }
    /// The same for the same piece in all courses.
    std::pair<double, double> name_of(const ShownSpan& piece) const { return {band_of(piece).from, piece.shown.from}; }
  };

  /// Of one axis if courses lie, of the other if they stand.
  SpanLine line(int exemplar, int exemplar_if_upright, int result, int result_if_upright, bool closed,
                bool closed_if_upright) const {
    if (courses_.upright) return {exemplar_if_upright, result_if_upright * level_.block, closed_if_upright};
    return {exemplar, result * level_.block, closed};
  }

  /// Calls `f(pixel of the field, along, across)` for what begins between two places along a line, in pixels of the
  /// finest level, around the border of a result that wraps.
  template <class F>
  void for_pixels(const ShownSpan& band, const ShownSpan& piece, const F& f) const {
    const int block = level_.block;
    const auto first = [&](double at) { return int(std::ceil(at / block)); };
    for (int v = first(band.begin); v < first(band.end); v++)
      for (int u = first(piece.begin); u < first(piece.end); u++) {
        const auto [x, y] = courses_.upright ? std::pair(v, u) : std::pair(u, v);
        if (const int64_t i = level_.window.field().index(x, y); i >= 0) f(i, u * block, v * block);
      }
  }

  bool is_fixed(int64_t i) const {
    const int width = field_.size.width;
    return level_.is_fixed(int(i % width), int(i / width));
  }

  /// Of several random orders the one that meets the band before least, and shows what was shown least.
  Course course_of(const ShownSpan& band, size_t number, const Course& before) const {
    constexpr int tries = 16;
    Course out{courses_.pieces_for(band.shown), {}};
    std::vector<ShownSpan> best;
    double least = 0;
    SpanOrder order(out.pool.pieces, along_, more_random_bits(bits_, number));
    if (level_.fixed.any()) keep(order, band, out.pool);
    for (int i = 0; i < tries; i++) {
      out.pieces = order.order();
      const double met = meeting(out, before, (band.end - band.begin) / 2) + unevenness(out);
      if (i == 0 || met < least) best = std::move(out.pieces);
      least = i == 0 ? met : std::min(least, met);
      if (least == 0) break;
    }
    out.pieces = std::move(best);
    return out;
  }

  void keep(SpanOrder& order, const ShownSpan& band, const CoursePieces& pool) const {
    const ShownSpan all{0, double(along_.result), 0, {}, 0};
    for_pixels(band, all, [&](int64_t i, int along, int) {
      if (!is_fixed(i)) return;
      const ExemplarPixel& p = field_.pixels[size_t(i)];
      const int across = courses_.upright ? p.x : p.y;
      order.keep(along, courses_.upright ? p.y : p.x, [&](size_t piece) {
        const ExemplarSpan& of = pool.bands[piece];
        const auto shows = [&](int v) { return v >= of.from && v < of.to; };
        return shows(across) || shows(across + across_.exemplar);
      });
    });
  }

  /// How many joints meet, those less than `reach` apart in part, and how many pieces lie beside themselves.
  double meeting(const Course& a, const Course& b, double reach) const {
    double sum = 0;
    for (const ShownSpan& p : a.pieces)
      for (const ShownSpan& q : b.pieces) {
        const double d = std::abs(p.begin - q.begin), apart = along_.closed ? std::min(d, along_.result - d) : d;
        sum += std::max(0.0, 1 - apart / reach);
        sum += a.name_of(p) == b.name_of(q) && p.begin < q.end && q.begin < p.end;
      }
    return sum;
  }

  /// How often its pieces have been shown, more than all that could be in the mean.
  double unevenness(const Course& course) const {
    const auto used = [&](const std::pair<double, double>& name) {
      const auto found = used_.find(name);
      return found == used_.end() ? 0.0 : double(found->second);
    };
    double mean = 0, sum = 0;
    for (size_t k = 0; k < course.pool.pieces.size(); k++)
      mean += used({course.pool.bands[k].from, course.pool.pieces[k].from}) / double(course.pool.pieces.size());
    for (const ShownSpan& piece : course.pieces) sum += std::max(0.0, used(course.name_of(piece)) - mean);
    return sum;
  }

  void show(const ShownSpan& band, Course& course) {
    for (ShownSpan& piece : course.pieces) {
      const ExemplarSpan& of = course.band_of(piece);
      if (piece.is_cut()) piece.cut = best_cut(of, piece);
      const int beside = int(std::floor((of.from + of.to - band.shown.from - band.shown.to) / 2 + 0.5));
      for_pixels(band, piece, [&](int64_t i, int along, int across) {
        int u = along + piece.shift(along), v = across + band.shift(across) + beside;
        if (courses_.upright) std::swap(u, v);
        if (!is_fixed(i) && level_.goes_on(u, v)) field_.pixels[size_t(i)] = {uint16_t(u), uint16_t(v)};
      });
    }
  }

  /// Where in its middle half the two parts of a piece meet in what looks most alike.
  double best_cut(const ExemplarSpan& band, const ShownSpan& piece) const {
    const double length = piece.end - piece.begin;
    double best = piece.cut;
    int64_t least = std::numeric_limits<int64_t>::max();
    for (double cut = std::floor(piece.begin + length / 4); cut < piece.end - length / 4; cut++) {
      const int before = int(cut + piece.shown.from - piece.begin), after = int(cut + piece.shown.to - piece.end);
      int64_t unlike = 0;
      for (int v = int(band.from); v < int(band.to); v++) unlike += squared_distance(look(before, v), look(after, v));
      if (unlike < least) best = cut;
      least = std::min(least, unlike);
    }
    return best;
  }

  const AppearanceVector& look(int along, int across) const {
    const auto [x, y] = courses_.upright ? std::pair(across, along) : std::pair(along, across);
    const Size size = looks_.size;
    return looks_.vectors[size_t(wrap(y, size.height)) * size_t(size.width) + size_t(wrap(x, size.width))];
  }

  Field& field_;
  const CorrectionLevel& level_;
  const AppearanceLevel& looks_;
  const ElementCourses& courses_;
  uint64_t bits_;
  SpanLine along_, across_;
  std::map<std::pair<double, double>, int> used_;  // how often each piece has been shown
};

}  // namespace

std::vector<ShownSpan> bands_of(const ElementCourses& courses, Size exemplar, const Plane& result,
                                const ExistingPixels& kept, uint64_t bits) {
  if (courses.empty()) return {};
  const Size size = result.size;
  // As many pixels as the blocks that they are laid in: those wrap.
  const auto in_blocks = [](int length) { return length + length % 2; };
  const SpanLine across = courses.upright ? SpanLine{exemplar.width, in_blocks(size.width), result.tile_x}
                                          : SpanLine{exemplar.height, in_blocks(size.height), result.tile_y};
  SpanOrder order(courses.bands, across, bits);
  const bool some_stay = std::ranges::find(kept.keep, Keep::always) != kept.keep.end();
  for (size_t i = 0; i < kept.keep.size(); i++) {
    if (kept.keep[i] != (some_stay ? Keep::always : Keep::at_first)) continue;
    const int x = int(i % size_t(size.width)), y = int(i / size_t(size.width));
    order.keep(courses.upright ? x : y, courses.upright ? kept.pixels[i].x : kept.pixels[i].y);
  }
  return order.order();
}

void lay_bands(Field& field, const CorrectionLevel& level, const Appearance& appearance, const ElementCourses& courses,
               const std::vector<ShownSpan>& bands, uint64_t bits, const Task& task) {
  BandLayout(field, level, appearance, courses, bits).lay(bands, task);
}

}  // namespace terrazzo
