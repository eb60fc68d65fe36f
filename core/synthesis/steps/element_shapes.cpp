#include "core/synthesis/steps/element_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <tbb/parallel_for.h>

#include "core/base/tuning.h"
#include "core/numeric/distance_transform.h"
#include "core/synthesis/state/plane_window.h"

namespace terrazzo {

namespace {

struct ElementShapesTuning {
  double margin = 0.4;
  double most_whole = 0.5;
  double least_cut = 0.35;
  int samples = 36;
  int outline = 40;
};
const Tunable<ElementShapesTuning> element_shapes_tuning(
    "element_shapes",
    {
        {&ElementShapesTuning::margin, "margin", "typical sides",
         "around an element within which its neighbours matter to it. Higher: wider gaps are "
         "closed; costs time and memory",
         "element_layout", 0.01, 4},
        {&ElementShapesTuning::samples, "samples", "blocks of an element",
         "that are compared when places for it are tried. Costs time", "element_layout", 1, 100000},
        {&ElementShapesTuning::outline, "outline", "blocks of its outline", "that are compared likewise",
         "element_layout", 4, 100000},
        {&ElementShapesTuning::most_whole, "most_whole", "of the exemplar",
         "that whole elements cover, below which cut ones are laid as well. Higher: more stones with "
         "a straight side; lower: less of the exemplar comes back",
         "element_layout", 0, 1},
        {&ElementShapesTuning::least_cut, "least_cut", "typical areas",
         "from which on a cut element is laid then. Higher: fewer; lower: slivers are laid", "element_layout", 0, 2},
    });

/// The exemplar's regions, one per block.
struct Grid {
  Plane plane;
  std::vector<uint16_t> at;

  /// -1 beyond the border of an exemplar that does not tile.
  int region(int x, int y) const {
    const int64_t i = plane.index(x, y);
    return i < 0 ? -1 : at[size_t(i)];
  }
};

struct Extent {
  std::vector<uint8_t> columns, rows;  ///< that it has blocks in
  int first_x = 0, first_y = 0;        ///< others count from there around the borders
  int left = 0, right = 0, top = 0, bottom = 0;
  double sum_x = 0, sum_y = 0;
};

/// After the longest run of lines around the borders without blocks of an element.
int first_of(const std::vector<uint8_t>& lines) {
  const int n = int(lines.size());
  int first = 0, longest = 0, run = 0;
  for (int i = 0; i < 2 * n; i++) {
    if (lines[size_t(i % n)] && run > longest) {
      longest = run;
      first = i % n;
    }
    run = lines[size_t(i % n)] ? 0 : run + 1;
  }
  return first;
}

void add_block(const Grid& grid, int x, int y, Extent& e, ElementShape& shape) {
  const Size& size = grid.plane.size;
  const int u = e.first_x + wrap(x - e.first_x, size.width), v = e.first_y + wrap(y - e.first_y, size.height);
  if (shape.area++ == 0) e.left = e.right = u, e.top = e.bottom = v;
  e.left = std::min(e.left, u);
  e.right = std::max(e.right, u);
  e.top = std::min(e.top, v);
  e.bottom = std::max(e.bottom, v);
  e.sum_x += u;
  e.sum_y += v;
  const bool at_border = x == 0 || y == 0 || x == size.width - 1 || y == size.height - 1;
  shape.cut |= !grid.plane.tile_x && at_border;
}

/// So that the first few tell what all of them will: each far from the one before.
void scatter(std::vector<ElementSample>& samples) {
  const std::vector<ElementSample> in_rows = samples;
  size_t stride = std::max<size_t>(1, in_rows.size() * 5 / 8);
  while (std::gcd(stride, in_rows.size()) > 1) stride++;
  for (size_t i = 0; i < in_rows.size(); i++) samples[i] = in_rows[i * stride % in_rows.size()];
}

void measure(const Grid& grid, int element, int margin, const Extent& e, ElementShape& shape) {
  shape.centre_x = int(std::floor(e.sum_x / double(shape.area) + 0.5));
  shape.centre_y = int(std::floor(e.sum_y / double(shape.area) + 0.5));
  shape.box = {e.left - margin - shape.centre_x, e.top - margin - shape.centre_y, e.right - e.left + 1 + 2 * margin,
               e.bottom - e.top + 1 + 2 * margin};
  // One that reaches around the exemplar to itself has no outline of its own.
  shape.unusable |= e.right - e.left + 1 >= grid.plane.size.width || e.bottom - e.top + 1 >= grid.plane.size.height;
  const auto for_blocks = [&](int first, int step, const auto& visit) {
    for (int y = shape.box.y + first; y < shape.box.bottom(); y += step)
      for (int x = shape.box.x + first; x < shape.box.right(); x += step) visit(x, y);
  };
  std::vector<uint8_t> inside;
  for_blocks(0, 1,
             [&](int x, int y) { inside.push_back(grid.region(x + shape.centre_x, y + shape.centre_y) == element); });
  shape.depths = signed_distances(inside, {shape.box.width, shape.box.height}, false, 1e6f);
  for (float& depth : shape.depths) depth = -depth;
  shape.inner_radius = std::max(shape.inner_radius, std::ranges::max(shape.depths));
  const int step = std::max(1, int(std::sqrt(double(shape.area) / element_shapes_tuning->samples)));
  for_blocks(step / 2, step, [&](int x, int y) {
    if (const float d = shape.depth(x, y); d > 0) shape.samples.push_back({int16_t(x), int16_t(y), d});
  });
  std::vector<ElementSample> outline;
  for_blocks(0, 1, [&](int x, int y) {
    if (const float d = shape.depth(x, y); std::abs(d) < 1) outline.push_back({int16_t(x), int16_t(y), d});
  });
  const size_t every = std::max<size_t>(1, outline.size() / size_t(element_shapes_tuning->outline));
  for (size_t i = 0; i < outline.size(); i += every) shape.outline.push_back(outline[i]);
  scatter(shape.samples);
}

/// Elements that the exemplar's border cuts. Where most of the exemplar lies in such, those end there that are not much
/// smaller: else too little would come back.
void reject_cut(std::vector<ElementShape>& shapes, double typical_side) {
  double whole = 0, all = 0;
  for (const ElementShape& s : shapes) {
    all += double(s.area);
    if (!s.cut) whole += double(s.area);
  }
  double least = std::numeric_limits<double>::infinity();
  if (whole < element_shapes_tuning->most_whole * all)
    least = element_shapes_tuning->least_cut * typical_side * typical_side;
  for (ElementShape& s : shapes) s.unusable |= s.cut && double(s.area) < least;
}

}  // namespace

double ElementShape::depth_between(double x, double y) const {
  const int left = int(std::floor(x)), top = int(std::floor(y));
  const double fx = x - left, fy = y - top;
  const double above = (1 - fx) * double(depth(left, top)) + fx * double(depth(left + 1, top));
  const double below = (1 - fx) * double(depth(left, top + 1)) + fx * double(depth(left + 1, top + 1));
  return (1 - fy) * above + fy * below;
}

ElementShapes element_shapes(const Elements& elements, const std::vector<uint8_t>& usable, int block, bool wraps) {
  ElementShapes out{.block = block, .all = std::vector<ElementShape>(size_t(elements.count))};
  const Size size{(elements.size.width + block - 1) / block, (elements.size.height + block - 1) / block};
  Grid grid{{size, wraps, wraps}, {}};
  const std::vector<uint8_t> no_columns(size_t(size.width), 0), no_rows(size_t(size.height), 0);
  std::vector<Extent> extents(out.all.size(), {.columns = no_columns, .rows = no_rows});
  const auto pixel_at = [&](int x, int y) {
    return size_t(y) * size_t(block) * size_t(elements.size.width) + size_t(x) * size_t(block);
  };
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const uint16_t element = grid.at.emplace_back(elements.at[pixel_at(x, y)]);
      extents[element].columns[size_t(x)] = extents[element].rows[size_t(y)] = 1;
      if (!usable.empty() && !usable[pixel_at(x, y)]) out.all[element].unusable = true;
    }
  if (wraps)
    for (Extent& e : extents) e.first_x = first_of(e.columns), e.first_y = first_of(e.rows);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const uint16_t element = grid.at[size_t(y) * size_t(size.width) + size_t(x)];
      add_block(grid, x, y, extents[element], out.all[element]);
    }
  double squares = 0;
  for (const ElementShape& s : out.all) squares += double(s.area) * double(s.area);
  out.typical_side = std::sqrt(squares / double(size.area()));
  const int margin = std::max(2, int(element_shapes_tuning->margin * out.typical_side));
  reject_cut(out.all, out.typical_side);
  tbb::parallel_for(0, elements.count, [&](int e) {
    // Blocks may miss the smallest regions.
    if (out.all[size_t(e)].area == 0)
      out.all[size_t(e)].unusable = true;
    else
      measure(grid, e, margin, extents[size_t(e)], out.all[size_t(e)]);
  });
  out.whole = int(std::ranges::count_if(out.all, [](const ElementShape& s) { return !s.unusable; }));
  return out;
}

}  // namespace terrazzo
