#include "core/resolve/joined_heights.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include <tbb/parallel_for.h>

#include "core/base/tuning.h"
#include "core/image/distribution.h"
#include "core/numeric/screened_poisson.h"

namespace terrazzo {

namespace {

struct JoinedHeightsTuning {
  double constraint_weight = 1000;
  int sweeps = 3;
  int rounds = 3;
};
const Tunable<JoinedHeightsTuning> joined_heights_tuning(
    "joined_heights",
    {
        {&JoinedHeightsTuning::constraint_weight, "constraint_weight", "links to a neighbour",
         "that holds a kept pixel. Higher: it moves less; lower: heights around it are found in fewer rounds",
         "not measured: all its neighbours together move it by a few thousandths of what they differ", 0, 1000000},
        {&JoinedHeightsTuning::sweeps, "sweeps", "rounds",
         "of smoothing the finest level, before and after the coarse part is added. Higher: less is left of steps; "
         "costs time, as a pixel sees twice as far",
         "not measured: taken over from the code before constants were listed", 1, 64},
        {&JoinedHeightsTuning::rounds, "rounds", "rounds",
         "in which the coarse part is found; each leaves about a third of the error. Higher: holes meet their rim "
         "better; costs time",
         "joined_heights"},
    });

constexpr double least_reach = 0.01;  ///< in pixels; shorter reaches count as 0
constexpr Size block{256, 64};

/// Calls `body` for the blocks of a region, in parallel.
template <typename Body>
void for_blocks(const Rect& region, const Body& body) {
  const int columns = (region.width + block.width - 1) / block.width;
  const int rows = (region.height + block.height - 1) / block.height;
  tbb::parallel_for(0, columns * rows, [&](int i) {
    const Rect part{region.x + i % columns * block.width, region.y + i / columns * block.height, block.width,
                    block.height};
    body(intersect(part, region));
  });
}

/// The link between pixel `i`, which may lie outside, and the one before it.
float link(const CellAxis& axis, int i) {
  if (axis.wraps) return axis.links[size_t(wrap(i, axis.count()))];
  return i < 0 || i > axis.count() ? 0 : axis.links[size_t(i)];
}

/// A pixel's place on the axis; -1 if it lies outside.
int placed(const CellAxis& axis, int i) {
  if (axis.wraps) return wrap(i, axis.count());
  return i < 0 || i >= axis.count() ? -1 : i;
}

class JoinedPixels : public PixelSource {
 public:
  JoinedPixels(const ImagePtr& map, std::shared_ptr<const FineLayout> layout, double reach, const KeptPixels& kept,
               const Task& task)
      : map_(materialized(map)),
        layout_(std::move(layout)),
        same_(map_->size() == layout_->exemplar()),
        heights_(map_->in_memory()),
        sweeps_(joined_heights_tuning->sweeps),
        constraint_weight_(float(joined_heights_tuning->constraint_weight)),
        steps_(smoothing_steps(sweeps_)),
        size_(layout_->size()),
        kept_(kept, size_),
        x_(CellAxis::of_pixels(size_.width, layout_->uv().wraps().x)),
        y_(CellAxis::of_pixels(size_.height, layout_->uv().wraps().y)) {
    const double fine = std::max(least_reach, reach * size_.width / layout_->uv().size().width);
    screen_ = float(1 / (fine * fine));
    range_ = value_ranges(*map_, Task()).front();
    if (!(range_.min < range_.max)) return;
    unit_ = double(range_.max) - range_.min;
    const CellAxis x = x_.coarser(), y = y_.coarser();
    x_shares_ = coarse_shares(x_, x);
    y_shares_ = coarse_shares(y_, y);
    coarse_.emplace(x, y, screen_);
    if (kept_.any()) coarse_->hold(coarse_holds());
    find_coarse(task);
    coarse_->finish();
  }

  void read(const Rect& region, float* out) const override {
    for_blocks(region, [&](const Rect& part) {
      Window window(*this, part);
      for (int y = 0; y < part.height; y++) {
        float* row = out + size_t(part.y + y - region.y) * region.width + (part.x - region.x);
        for (int x = 0; x < part.width; x++) {
          const float* kept = kept_.at(part.x + x, part.y + y);
          row[x] = kept ? *kept : moved(window.source(x, y), window.value(x, y));
        }
      }
    });
  }

 private:
  /// The solution around a region of the output.
  class Window {
   public:
    Window(const JoinedPixels& of, const Rect& region)
        : of_(of), apron_(2 * of.sweeps_), area_(grown(region, apron_)), widths_(size_t(area_.width), 1.0f) {
      const size_t pixels = size_t(area_.area());
      sources_.assign(pixels, outside);
      forces_.assign(pixels, 0.0f);
      values_.assign(pixels, 0.0f);
      none_held_.assign(size_t(area_.width), 0.0f);
      for (int x = 0; x <= area_.width; x++) links_.push_back(link(of.x_, area_.x + x));
      find_sources();
      if (!of.coarse_) return;
      find_forces();
      if (of.kept_.any()) hold_kept();
      smooth(0);
      add_coarse();
      smooth(of.sweeps_);
    }
    const Offset& source(int x, int y) const { return sources_[at(x + apron_, y + apron_)]; }
    float value(int x, int y) const { return values_[at(x + apron_, y + apron_)]; }
    /// The residuals of a row, without its outermost pixels.
    void residuals(int y, int count, float* out) const {
      terrazzo::residuals(cells(apron_ + 1, apron_ + y, count), out);
    }

   private:
    size_t at(int x, int y) const { return size_t(y) * size_t(area_.width) + size_t(x); }

    CellRow cells(int x, int y, int count) const {
      return {.count = count,
              .widths = widths_.data(),
              .links = &links_[size_t(x)],
              .height = 1,
              .link_above = link(of_.y_, area_.y + y),
              .link_below = link(of_.y_, area_.y + y + 1),
              .above = &values_[at(x, y - 1)],
              .here = &values_[at(x, y)],
              .below = &values_[at(x, y + 1)],
              .forces = &forces_[at(x, y)],
              .holds = of_.kept_.any() ? &holds_[at(x, y)] : none_held_.data(),
              .screen = of_.screen_};
    }

    void find_sources() {
      for (int y = 0; y < area_.height; y++) {
        const int v = placed(of_.y_, area_.y + y);
        if (v < 0) continue;
        for (int x = 0, count = 1; x < area_.width; x += count, count = 1) {
          const int u = placed(of_.x_, area_.x + x);
          if (u < 0) continue;
          count = std::min(area_.width - x, of_.size_.width - u);
          of_.layout_->shown(u, v, count, &sources_[at(x, y)]);
        }
      }
    }

    void find_forces() {
      std::vector<float> above(size_t(area_.width), 0.0f);
      for (int y = 0; y + 1 < area_.height; y++) {
        const Offset *row = &sources_[at(0, y)], *next = &sources_[at(0, y + 1)];
        float* out = &forces_[at(0, y)];
        float left = 0;
        for (int x = 0; x + 1 < area_.width; x++) {
          const float right = of_.step(row[x], row[x + 1], {1, 0}), below = of_.step(row[x], next[x], {0, 1});
          out[x] = (left - right) + (above[size_t(x)] - below);
          left = right;
          above[size_t(x)] = below;
        }
      }
    }

    void hold_kept() {
      holds_.assign(forces_.size(), 0.0f);
      for (int y = 0; y < area_.height; y++)
        for (int x = 0; x < area_.width; x++) {
          const size_t i = at(x, y);
          float by;
          if (sources_[i].x < 0 ||
              !of_.holds(placed(of_.x_, area_.x + x), placed(of_.y_, area_.y + y), sources_[i], by))
            continue;
          holds_[i] = of_.constraint_weight_;
          forces_[i] += of_.constraint_weight_ * by;
          values_[i] = by;
        }
    }

    void add_coarse() {
      for (int y = 0; y < area_.height; y++) {
        const int v = placed(of_.y_, area_.y + y);
        if (v < 0) continue;
        const CoarseShare& share = of_.y_shares_[size_t(v)];
        const float *near = of_.coarse_->values(share.near), *far = of_.coarse_->values(share.far);
        const auto along = [&](int x) { return near[x] + share.far_share * (far[x] - near[x]); };
        for (int x = 0; x < area_.width; x++) {
          const int u = placed(of_.x_, area_.x + x);
          if (u < 0) continue;
          if (of_.kept_.any() && holds_[at(x, y)] > 0) continue;
          const CoarseShare& h = of_.x_shares_[size_t(u)];
          const float value = along(h.near);
          values_[at(x, y)] += value + h.far_share * (along(h.far) - value);
        }
      }
    }

    /// Takes values that are right at least `seen` pixels inside the area; each step leaves one pixel less on every
    /// side.
    void smooth(int seen) {
      changed_.resize(values_.size());
      for (const float step : of_.steps_) {
        seen++;
        for (int y = seen; y < area_.height - seen; y++)
          relaxed(cells(seen, y, area_.width - 2 * seen), step, &changed_[at(seen, y)]);
        std::swap(values_, changed_);
      }
    }

    static constexpr Offset outside{-1, -1};
    const JoinedPixels& of_;
    int apron_;  ///< how far a pixel sees at this level
    Rect area_;
    std::vector<float> widths_, links_;
    std::vector<Offset> sources_;
    std::vector<float> forces_, values_, changed_;
    std::vector<float> holds_, none_held_;  ///< of all pixels if any is kept; else of a row
  };

  float height(const Offset& place) const {
    Offset p = place;
    if (!same_) {
      p.x = int(int64_t{p.x} * map_->width() / layout_->exemplar().width);
      p.y = int(int64_t{p.y} * map_->height() / layout_->exemplar().height);
    }
    return heights_[size_t(p.y) * size_t(map_->width()) + size_t(p.x)];
  }

  float moved(const Offset& place, float by) const {
    const float v = height(place);
    return std::isfinite(v) ? std::clamp(float(v + unit_ * by), range_.min, range_.max) : v;
  }

  /// The difference between a place of the exemplar and the next one on the way; 0 at its border.
  double slope(const Offset& from, const Offset& way) const {
    Offset to{from.x + way.x, from.y + way.y};
    return layout_->inside(to.x, to.y) ? double(height(to)) - height(from) : 0;
  }

  /// By how much the difference from a pixel to its neighbour must grow, in parts of the range.
  float step(const Offset& from, const Offset& to, const Offset& way) const {
    if (from.x < 0 || to.x < 0) return 0;
    Offset next{from.x + way.x, from.y + way.y};
    if (next == to) return 0;
    const Offset back{-way.x, -way.y};
    Offset before{to.x - way.x, to.y - way.y};
    const bool goes_on = layout_->inside(next.x, next.y), came = layout_->inside(before.x, before.y);
    if (goes_on && next == to) return 0;
    double first = goes_on ? slope(from, way) : -slope(from, back);
    double second = came ? -slope(to, back) : slope(to, way);
    if (!std::isfinite(first)) first = second;
    if (!std::isfinite(second)) second = first;
    const double is = double(height(to)) - height(from);
    if (!std::isfinite(first) || !std::isfinite(is)) return 0;
    return float((std::clamp(is, std::min(first, second), std::max(first, second)) - is) / unit_);
  }

  /// Whether the height of a pixel is kept; then `by` is how far the shown height must move.
  bool holds(int x, int y, const Offset& source, float& by) const {
    const float* kept = kept_.at(x, y);
    if (!kept) return false;
    by = float((double(*kept) - height(source)) / unit_);
    return std::isfinite(by);
  }

  /// The part of each coarse cell that is kept.
  std::vector<float> coarse_holds() const {
    const int columns = (size_.width + 1) / 2;
    std::vector<float> out(size_t(columns) * size_t((size_.height + 1) / 2), 0.0f);
    tbb::parallel_for(0, (size_.height + 1) / 2, [&](int row) {
      std::vector<Offset> sources(size_t(size_.width), Offset{});
      for (int y = 2 * row; y < std::min(2 * row + 2, size_.height); y++) {
        layout_->shown(0, y, size_.width, sources.data());
        for (int x = 0; x < size_.width; x++)
          if (float by; holds(x, y, sources[size_t(x)], by))
            out[size_t(row) * size_t(columns) + size_t(x / 2)] += constraint_weight_;
      }
    });
    return out;
  }

  void find_coarse(const Task& task) {
    const int rounds = joined_heights_tuning->rounds;
    const int64_t blocks = (size_.area() / block.area() + 1) * rounds;
    std::atomic<int64_t> done{0};
    for (int i = 0; i < rounds; i++) {
      for_blocks(whole(size_), [&](const Rect& part) {
        task.progress(std::min(1.0, double(done++) / double(blocks)));
        const Window window(*this, grown(part, 1));
        std::vector<float> row(size_t(part.width));
        for (int v = 0; v < part.height; v++) {
          window.residuals(v + 1, part.width, row.data());
          float* forces = coarse_->forces((part.y + v) / 2) + part.x / 2;
          for (size_t u = 0; u < row.size(); u++) forces[u / 2] += row[u];
        }
      });
      coarse_->improve(task);
    }
  }

  ImagePtr map_;
  std::shared_ptr<const FineLayout> layout_;
  bool same_;             ///< the map has the exemplar's size
  const float* heights_;  ///< of the map
  int sweeps_;
  float constraint_weight_;
  std::vector<float> steps_;
  Size size_;
  KeptLookup kept_;
  CellAxis x_, y_;  ///< of the output's pixels
  std::vector<CoarseShare> x_shares_, y_shares_;
  std::optional<ScreenedPoisson> coarse_;  ///< coarse part of the solution; none if there is nothing to join
  ValueRange range_;                       ///< of the exemplar
  double unit_ = 1;                        ///< of the solution
  float screen_ = 1;
};

}  // namespace

bool can_join(const ImageInfo& info) {
  return info.semantic == Semantic::height && info.channels == 1;
}

ImagePtr joined_heights(const ImagePtr& map, const std::shared_ptr<const FineLayout>& layout, double reach,
                        const KeptPixels& kept, const Task& task) {
  ImageInfo info = map->info();
  info.size = layout->size();
  Hasher recipe;
  recipe.add("joined heights").add(map->digest()).add(layout->uv().digest());
  recipe.add(layout->exemplar().width).add(layout->exemplar().height).add(reach);
  if (kept.map) recipe.add(kept.map->digest()).add(kept.x).add(kept.y);
  if (kept.map && kept.holes) recipe.add(kept.holes->digest());
  return Image::computed(info, recipe.digest(), std::make_shared<JoinedPixels>(map, layout, reach, kept, task));
}

}  // namespace terrazzo
