#include <cmath>

#include "core/base/portable_math.h"
#include "core/procedural/cell_table.h"
#include "core/procedural/pattern_types.h"

namespace terrazzo {

namespace {

using namespace portable;

struct Site {
  double x, y;  ///< in cells
};

struct Cell {
  int64_t column, row;
  double distance;  ///< to the border with the nearest neighbour, corners rounded; in cells
  double x, y;      ///< from the site, in cells
};

/// A street of rounded stones: cells around relaxed points, with earth and moss between them.
class Cobbles : public Surface {
 public:
  enum Salt : uint64_t {
    stone = 1,
    warp_u,
    warp_v,
    swell,
    rough,
    specks,
    earth,
    pebble,
    moss_patch,
    moss_tuft,
    wet,
    seam
  };

  Cobbles(const Canvas& canvas, const PatternSpec& spec, const Palette& palette)
      : canvas_(canvas),
        spec_(spec),
        palette_(palette),
        grid_(canvas, spec.scale, 1.12, 2),
        per_stone_(1 / grid_.cell_width()),
        loose_(canvas, grid_, stone, [&](int column, int row, Dice& dice) { return thrown(column, row, dice); }),
        sites_(canvas, grid_, stone, [&](int column, int row, Dice&) { return relaxed(column, row); }) {}

  SurfacePoint at(double u, double v) const override {
    const Cell cell = cell_around(u, v);
    Dice dice(grid_.bits(cell.column, cell.row, stone + 32));
    const double gap = 0.045 + 0.045 * spec_.irregularity * dice.unit();
    const double edge = canvas_.fbm(u, v, per_stone_ * 7, 4, 0.55, seam);
    const double d = cell.distance - gap + 0.03 * edge;
    const SurfacePoint ground = ground_at(u, v, d);
    if (d <= -0.02) return ground;
    const SurfacePoint top = stone_at(u, v, d, cell, dice);
    // Earth has washed over the low rims of the stones.
    const double above = smoothstep(-0.02, 0.05, top.height - ground.height);
    SurfacePoint p;
    p.height = std::max(top.height, ground.height);
    p.color = mix(ground.color, top.color, above);
    p.roughness = mix(ground.roughness, top.roughness, above);
    return p;
  }

  uint64_t element(double u, double v) const override {
    const Cell cell = cell_around(u, v);
    return grid_.id(cell.column, cell.row);
  }

 private:
  Site thrown(int column, int row, Dice& dice) const {
    const double jitter = 0.25 + 0.5 * spec_.irregularity;
    return {column + 0.5 + 0.5 * double(row & 1) + jitter * 0.5 * dice.both(), row + 0.5 + jitter * 0.5 * dice.both()};
  }

  /// One step of relaxation: away from the neighbours that are too near.
  Site relaxed(int column, int row) const {
    const Site here = loose_.at(column, row);
    Site moved = here;
    for (int j = -1; j <= 1; j++)
      for (int i = -1; i <= 1; i++) {
        if (i == 0 && j == 0) continue;
        if (!loose_.holds(column + i, row + j)) continue;
        const Site& other = loose_.at(column + i, row + j);
        const double dx = here.x - other.x, dy = here.y - other.y, length = std::sqrt(dx * dx + dy * dy);
        const double push = std::max(0.0, 1.0 - length) * 0.3 / std::max(length, 0.1);
        moved.x += dx * push;
        moved.y += dy * push;
      }
    return moved;
  }

  Cell cell_around(double u, double v) const {
    const double bend = grid_.cell_width() * 0.10;
    return cell_at(u + bend * canvas_.fbm(u, v, per_stone_ * 1.6, 3, 0.5, warp_u),
                   v + bend * canvas_.fbm(u, v, per_stone_ * 1.6, 3, 0.5, warp_v));
  }

  Cell cell_at(double u, double v) const {
    const double x = u / grid_.cell_width(), y = v / grid_.cell_height();
    const int64_t row = floor_int(y), column = floor_int(x);
    Cell best{};
    double nearest = 1e9;
    for (int64_t j = row - 1; j <= row + 1; j++)
      for (int64_t i = column - 2; i <= column + 1; i++) {
        const Site& s = sites_.at(i, j);
        const double dx = x - s.x, dy = y - s.y, distance = dx * dx + dy * dy;
        if (distance < nearest) {
          nearest = distance;
          best = {i, j, 0, dx, dy};
        }
      }
    const Site& own = sites_.at(best.column, best.row);
    double sum = 0;
    for (int64_t j = best.row - 2; j <= best.row + 2; j++)
      for (int64_t i = best.column - 2; i <= best.column + 2; i++) {
        if (i == best.column && j == best.row) continue;
        const Site& s = sites_.at(i, j);
        const double nx = s.x - own.x, ny = s.y - own.y, length = std::sqrt(nx * nx + ny * ny);
        const double border = std::max(1e-3, length / 2 - (best.x * nx + best.y * ny) / length);
        const double inverse = 1 / (border * border);
        sum += inverse * inverse;
      }
    // A soft minimum of the distances to all borders rounds the corners.
    best.distance = 1 / std::sqrt(std::sqrt(sum));
    return best;
  }

  SurfacePoint stone_at(double u, double v, double d, const Cell& cell, Dice& dice) const {
    const Rgb base = pick_color(palette_.pieces, dice);
    const double tone = 1 + 0.18 * dice.both(), lift = dice.both(), lean_x = dice.both(), lean_y = dice.both();
    const double warm = dice.both();
    const double t = saturate(d / 0.34), round = std::sqrt(std::max(0.0, 1 - (1 - t) * (1 - t)));
    const double waves = canvas_.fbm(u, v, per_stone_ * 2.7, 4, 0.52, swell);
    const double fine = canvas_.fbm(u, v, per_stone_ * 18, 5, 0.7, rough);
    SurfacePoint p;
    p.height = 0.16 + 0.58 * round + 0.13 * waves * round + 0.055 * fine + 0.08 * spec_.irregularity * lift +
               0.12 * spec_.irregularity * (lean_x * cell.x + lean_y * cell.y);
    Rgb c = base * (tone + 0.30 * waves + 0.26 * fine);
    c = c + Rgb{0.014, 0.002, -0.016} * (warm + 0.4 + 1.5 * waves);
    // Crystals of the rock, pale and dark.
    const CellPoint crystal = canvas_.cells(u, v, per_stone_ * 34, specks);
    Dice kind(crystal.bits);
    const double which = kind.both(), spot = smoothstep(0.5, 0.2, crystal.nearest);
    c = c * (1 + (which > 0 ? 0.30 : 0.34) * which * which * which * spot);
    // Feet and wheels polish the crown; dirt stays at the rim.
    const double crown = smoothstep(0.35, 1.0, round);
    const double dirt = smoothstep(0.75, 0.1, round + 0.4 * fine + 0.25 * waves);
    c = mix(c, palette_.joint * 0.9, 0.65 * dirt * (0.4 + 0.6 * spec_.wear));
    const double damp = smoothstep(0.05, 0.5, canvas_.fbm(u, v, 2.5, 5, 0.55, wet));
    p.color = mix(c, c * 0.72, 0.7 * damp * spec_.wear);
    p.roughness = 0.82 - 0.26 * crown * (0.4 + 0.6 * spec_.wear) + 0.14 * fine - 0.08 * damp;
    return p;
  }

  SurfacePoint ground_at(double u, double v, double d) const {
    const double coarse = canvas_.fbm(u, v, per_stone_ * 5, 4, 0.6, earth);
    const double fine = canvas_.fbm(u, v, per_stone_ * 30, 4, 0.75, earth + 32);
    SurfacePoint p;
    p.height = 0.2 + 0.08 * coarse + 0.06 * fine;
    p.color = palette_.joint * (0.9 + 0.35 * coarse + 0.4 * fine);
    p.roughness = 0.93 + 0.05 * fine;
    const CellPoint grit = canvas_.cells(u, v, per_stone_ * 22, pebble);
    Dice kind(grit.bits);
    if (kind.unit() < 0.4) {
      const double radius = 0.2 + 0.25 * kind.unit(), bump = smoothstep(radius, 0, grit.nearest);
      p.height += 0.09 * bump;
      p.color = mix(p.color, palette_.joint * (1.1 + 0.5 * kind.both()), smoothstep(0.0, 0.4, bump));
    }
    const double patch = canvas_.fbm(u, v, per_stone_ * 0.8, 4, 0.55, moss_patch) + 0.55 * spec_.wear - 0.3;
    const double moss = smoothstep(-0.02, 0.22, patch + 0.25 * fine - 0.8 * std::max(0.0, d));
    if (moss > 0) {
      const double tuft = canvas_.fbm(u, v, per_stone_ * 14, 5, 0.75, moss_tuft);
      p.height += moss * (0.08 + 0.16 * tuft);
      const Rgb green = palette_.stain * (0.95 + 0.9 * tuft) + Rgb{0.10, 0.07, 0.0} * coarse;
      p.color = mix(p.color, green, moss);
      p.roughness = mix(p.roughness, 0.97, moss);
    }
    return p;
  }

  Canvas canvas_;
  PatternSpec spec_;
  Palette palette_;
  Grid grid_;
  double per_stone_;
  CellTable<Site> loose_;
  CellTable<Site> sites_;
};

}  // namespace

PatternType cobbles_pattern() {
  PatternType t;
  t.name = "cobbles";
  t.summary = "rounded paving stones with earth and moss between them";
  t.scale = 7;
  t.depth = 0.32;
  t.cavity = 0.55;
  t.palettes = {
      {"granite",
       {rgb(0x84827e), rgb(0x97928a), rgb(0x6f7073), rgb(0x8b7f74), rgb(0x7a7c80)},
       rgb(0x57493a),
       rgb(0x4c5a25)},
      {"sandstone",
       {rgb(0xb29a76), rgb(0xa3845f), rgb(0xc1ad8c), rgb(0x9c8a72), rgb(0xad8e78)},
       rgb(0x6b5a43),
       rgb(0x5f6630)},
      {"basalt", {rgb(0x4d4f52), rgb(0x5b5c5c), rgb(0x434548), rgb(0x605a55)}, rgb(0x7a6f5f), rgb(0x46522a)},
  };
  t.make = make_surface<Cobbles>;
  return t;
}

}  // namespace terrazzo
