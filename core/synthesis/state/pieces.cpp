#include "core/synthesis/state/pieces.h"

#include <algorithm>
#include <numeric>

#include "core/base/disjoint_sets.h"
#include "core/synthesis/state/correction_level.h"

namespace terrazzo {

Pieces::Pieces(const Field& field, const CorrectionLevel& level) {
  const Size size = field.size;
  const auto continues = [&](int from, int to, int dx, int dy) {
    return level.is_next(field.pixels[size_t(from)], field.pixels[size_t(to)], dx, dy);
  };
  std::vector<Run> runs;
  std::vector<size_t> rows{0};  // where each row's runs begin
  for (int y = 0; y < size.height; y++) {
    for (int x = 0; x < size.width; x++) {
      const int i = y * size.width + x;
      if (x > 0 && continues(i - 1, i, 1, 0))
        runs.back().length++;
      else
        runs.push_back({i, 1});
    }
    rows.push_back(runs.size());
  }
  DisjointSets joined{runs.size()};
  // Two runs that continue one another do so wherever they meet.
  const auto join_rows = [&](int upper, int lower) {
    size_t a = rows[size_t(upper)], b = rows[size_t(lower)];
    while (a < rows[size_t(upper) + 1] && b < rows[size_t(lower) + 1]) {
      const int a_x = runs[a].first - upper * size.width, b_x = runs[b].first - lower * size.width;
      const int x = std::max(a_x, b_x), a_end = a_x + runs[a].length, b_end = b_x + runs[b].length;
      if (continues(upper * size.width + x, lower * size.width + x, 0, 1)) joined.join(uint32_t(a), uint32_t(b));
      a += a_end <= b_end;
      b += b_end <= a_end;
    }
  };
  for (int y = 0; y < size.height; y++) {
    const size_t first = rows[size_t(y)], last = rows[size_t(y) + 1] - 1;
    if (level.window.closed_x && continues(runs[last].first + runs[last].length - 1, runs[first].first, 1, 0))
      joined.join(uint32_t(first), uint32_t(last));
    if (y > 0 || level.window.closed_y) join_rows(y > 0 ? y - 1 : size.height - 1, y);
  }
  std::vector<int> piece(runs.size());
  std::vector<int> counts;
  for (size_t i = 0; i < runs.size(); i++) {
    const size_t first = joined.find(uint32_t(i));
    piece[i] = first == i ? count() : piece[first];
    if (first == i) {
      areas_.push_back(0);
      counts.push_back(0);
    }
    areas_[size_t(piece[i])] += runs[i].length;
    counts[size_t(piece[i])]++;
  }
  begin_.assign(counts.size() + 1, 0);
  std::partial_sum(counts.begin(), counts.end(), begin_.begin() + 1);
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  runs_.resize(runs.size());
  for (size_t i = 0; i < runs.size(); i++) runs_[size_t(next[size_t(piece[i])]++)] = runs[i];
}

std::vector<int> Pieces::members(int piece) const {
  std::vector<int> out;
  out.reserve(size_t(area(piece)));
  for (int r = begin_[size_t(piece)]; r < begin_[size_t(piece) + 1]; r++)
    for (int i = 0; i < runs_[size_t(r)].length; i++) out.push_back(runs_[size_t(r)].first + i);
  return out;
}

}  // namespace terrazzo
