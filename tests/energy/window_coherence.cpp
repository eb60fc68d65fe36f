#include "tests/energy/window_coherence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

namespace terrazzo {

namespace {

constexpr int reach = WindowCoherence::reach, side = WindowCoherence::side;

constexpr double usual_share = 0.95;      // of the exemplar's windows, by which the figure `broken` is defined
constexpr double sampled_windows = 1024;  // of the exemplar: about fifty of them lie beyond usual_share
constexpr int64_t no_distance = std::numeric_limits<int64_t>::max();

/// Searches the exemplar's window that is nearest to a given one, and nearer than a limit.
class NearestWindow {
 public:
  NearestWindow(const CorrectionLevel& level, const WindowCoherence::Window& shown, int64_t limit = no_distance)
      : level_(level), shown_(shown), least_(limit) {
    for (size_t i = 0; i < shown.size(); i++) wanted_[i] = *level.exemplar.at(shown[i].x, shown[i].y);
  }
  /// The squared distance to the nearest so far; the limit if there is none.
  int64_t distance() const { return least_; }

  /// Considers the windows that the window's pixels continue.
  void consider_continued() {
    constexpr int middle = side * side / 2;
    continue_with(middle);
    for (int i = 0; i < side * side && least_ > 0; i++) continue_with(i);
  }

  /// Considers those that k-coherent candidates of the window's corners and middle continue.
  void consider_similar() {
    if (level_.similar.empty()) return;
    for (int dy = -reach; dy <= reach && least_ > 0; dy += reach)
      for (int dx = -reach; dx <= reach; dx += reach) {
        if ((dx == 0) != (dy == 0)) continue;
        const ExemplarPixel p = shown_[(dy + reach) * side + dx + reach];
        for (const ExemplarPixel& q : level_.similar_to(p)) consider(q.x - dx, q.y - dy);
      }
  }

  /// Considers the window around a place.
  void consider(int u, int v) {
    const Size size = level_.exemplar.size();
    if (u < reach || v < reach || u >= size.width - reach || v >= size.height - reach) return;
    if (!level_.exemplar.is_usable(u, v)) return;
    if (!is_new(u, v)) return;
    int64_t sum = 0;
    for (int i = 0; i < side * side && sum < least_; i++)
      sum += squared_distance(wanted_[size_t(i)], *level_.exemplar.at(u + i % side - reach, v + i / side - reach));
    least_ = std::min(least_, sum);
  }

  /// Leaves a place out.
  void forget(int u, int v) { is_new(u, v); }

 private:
  /// Whether the place is seen for the first time. Most pixels of a window continue one of a few.
  bool is_new(int u, int v) {
    const uint32_t place = packed(u, v);
    if (std::find(tried_.begin(), tried_.begin() + count_, place) != tried_.begin() + count_) return false;
    tried_[size_t(count_++)] = place;
    return true;
  }
  void continue_with(int i) { consider(shown_[i].x - (i % side - reach), shown_[i].y - (i / side - reach)); }

  const CorrectionLevel& level_;
  const WindowCoherence::Window& shown_;
  std::array<AppearanceVector, side * side> wanted_;
  // The window's pixels, the candidates of five of them, and own_distance()'s place and its four neighbours.
  std::array<uint32_t, side * side + 5 * most_similar + 5> tried_;
  ptrdiff_t count_ = 0;
  int64_t least_;
};

/// The squared distance from the exemplar's window around a place to the nearest other one.
int64_t own_distance(const CorrectionLevel& level, int u, int v) {
  WindowCoherence::Window window;
  for (int i = 0; i < side * side; i++) window[i] = {uint16_t(u + i % side - reach), uint16_t(v + i / side - reach)};
  NearestWindow nearest(level, window);
  nearest.forget(u, v);
  for (const auto& [dx, dy] : sides) nearest.consider(u + dx, v + dy);
  nearest.consider_similar();
  return nearest.distance();
}

double usual_distance(const CorrectionLevel& level) {
  const Size size = level.exemplar.size();
  const int step = std::max(1, int(std::sqrt(double(size.area()) / sampled_windows)));
  const int columns = (size.width - 2 * reach + step - 1) / step, rows = (size.height - 2 * reach + step - 1) / step;
  if (columns <= 0 || rows <= 0) return 0;
  std::vector<int64_t> distances(size_t(columns) * rows);
  tbb::parallel_for(0, rows, [&](int row) {
    for (int column = 0; column < columns; column++)
      distances[size_t(row) * columns + column] = own_distance(level, reach + column * step, reach + row * step);
  });
  std::erase(distances, no_distance);
  if (distances.empty()) return 0;
  const size_t rank = std::min(distances.size() - 1, size_t(usual_share * double(distances.size())));
  const auto usual = distances.begin() + ptrdiff_t(rank);
  std::nth_element(distances.begin(), usual, distances.end());
  return double(*usual);
}

}  // namespace

WindowCoherence::WindowCoherence(const CorrectionLevel& level) : level_(level), usual_(usual_distance(level)) {}

bool WindowCoherence::is_copied(const Window& shown) {
  const ExemplarPixel first = shown[0];
  for (int i = 1; i < side * side; i++)
    if (shown[size_t(i)].x != first.x + i % side || shown[size_t(i)].y != first.y + i / side) return false;
  return true;
}

int32_t WindowCoherence::distance(const Window& shown) const {
  if (usual_ == 0 || is_copied(shown)) return 0;
  constexpr int64_t far = int64_t{farthest / usual} * (farthest / usual);
  NearestWindow nearest(level_, shown, int64_t(usual_ * double(far)));
  nearest.consider_continued();
  nearest.consider_similar();
  return int32_t(std::sqrt(double(nearest.distance()) / usual_) * usual);
}

}  // namespace terrazzo
