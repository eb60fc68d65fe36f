#include "core/resolve/joined_tones.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/tuning.h"
#include "core/image/distribution.h"
#include "core/image/normal.h"
#include "core/image/pixel_space.h"

namespace terrazzo {

namespace {

struct JoinedTonesTuning {
  double seen = 0.25;
  double kept_weight = 8;
};
const Tunable<JoinedTonesTuning> joined_tones_tuning(
    "joined_tones", {{&JoinedTonesTuning::seen, "seen", "deviations of nearby tones",
                      "how far a tone must be from its surroundings to be moved. Higher: only seams across smooth "
                      "places are joined; lower: stains lose contrast",
                      "slow_tones", 0, 1000},
                     {&JoinedTonesTuning::kept_weight, "kept_weight", "times the weight of other pixels",
                      "higher: tones meet those of kept pixels more closely; lower: over a longer distance",
                      "not measured: what is left of a step is a ninth of it", 1, 1000000}});

constexpr int nodes_per_reach = 4;
constexpr int most_channels = 4;

class TonePixels : public PixelSource {
 public:
  TonePixels(ImagePtr resolved, const ImagePtr& map, std::shared_ptr<const FineLayout> layout, SlowTonesPtr tones,
             const KeptPixels& kept)
      : resolved_(std::move(resolved)),
        layout_(std::move(layout)),
        tones_(std::move(tones)),
        channels_(size_t(tones_->channels())),
        step_(std::max(1, int(tones_->reach() / nodes_per_reach + 0.5))),
        seen_(float(joined_tones_tuning->seen)),
        kept_weight_(float(joined_tones_tuning->kept_weight)),
        kept_(kept, layout_->size()),
        ranges_(value_ranges(*map, Task())) {}

  void read(const Rect& region, float* out) const override {
    resolved_->read(region, out);
    const Nodes nodes(*this, region);
    std::vector<Offset> shown(size_t(region.width));
    const auto stored = size_t(resolved_->channels());
    for (int y = region.y; y < region.bottom(); y++) {
      layout_->shown(region.x, y, region.width, shown.data());
      for (int x = region.x; x < region.right(); x++, out += stored)
        if (const float* kept = kept_.at(x, y))
          std::copy_n(kept, stored, out);
        else
          join(nodes, x, y, shown[size_t(x - region.x)], out);
    }
  }

 private:
  using Tone = std::array<float, most_channels>;
  struct Proposal {
    Offset offset;  ///< from a place of the plane to the exemplar pixel that it shows
    float weight;
  };

  /// Joined tones on a grid that starts at the output's first pixel, around a region.
  class Nodes {
   public:
    Nodes(const TonePixels& of, const Rect& region)
        : step_(of.step_),
          left_(region.x / step_),
          top_(region.y / step_),
          columns_((region.right() - 1) / step_ + 2 - left_),
          rows_((region.bottom() - 1) / step_ + 2 - top_) {
      constexpr int apron = nodes_per_reach - 1;  // at `nodes_per_reach` the weight is 0
      const int across = columns_ + 2 * apron, down = rows_ + 2 * apron;
      std::vector<Proposal> proposals(size_t(across) * size_t(down));
      for (int j = 0; j < down; j++)
        for (int i = 0; i < across; i++)
          proposals[size_t(j) * size_t(across) + size_t(i)] =
              of.proposal((left_ + i - apron) * step_, (top_ + j - apron) * step_);
      tones_.resize(size_t(columns_) * size_t(rows_));
      for (int j = 0; j < rows_; j++)
        for (int i = 0; i < columns_; i++) {
          Tone& tone = tones_[size_t(j) * size_t(columns_) + size_t(i)];
          float weights = 0;
          for (int dy = -apron; dy <= apron; dy++)
            for (int dx = -apron; dx <= apron; dx++) {
              const float share = 1 - float(dx * dx + dy * dy) / float(nodes_per_reach * nodes_per_reach);
              const Proposal& p = proposals[size_t(j + dy + apron) * size_t(across) + size_t(i + dx + apron)];
              Offset place{(left_ + i) * step_ + p.offset.x, (top_ + j) * step_ + p.offset.y};
              if (share <= 0) continue;
              of.layout_->settle(place.x, place.y);  // beyond the exemplar its border's tone goes on
              const float weight = share * share * p.weight;
              of.tones_->add(place.x, place.y, weight, tone.data());
              weights += weight;
            }
          for (float& t : tone) t /= weights;
        }
    }

    Tone at(int x, int y) const {
      const int column = x / step_ - left_, row = y / step_ - top_;
      const float right = float(x % step_) / float(step_), below = float(y % step_) / float(step_);
      const Tone* first = &tones_[size_t(row) * size_t(columns_) + size_t(column)];
      const Tone* next = first + columns_;
      Tone out{};
      for (size_t c = 0; c < out.size(); c++) {
        const float upper = first[0][c] + right * (first[1][c] - first[0][c]);
        const float lower = next[0][c] + right * (next[1][c] - next[0][c]);
        out[c] = upper + below * (lower - upper);
      }
      return out;
    }

   private:
    int step_, left_, top_, columns_, rows_;
    std::vector<Tone> tones_;
  };

  /// What a place of the plane proposes. Beyond borders that do not wrap, pieces continue.
  Proposal proposal(int x, int y) const {
    const Size size = layout_->size();
    const auto& wraps = layout_->uv().wraps();
    const int column = wraps.x ? wrap(x, size.width) : std::clamp(x, 0, size.width - 1);
    const int row = wraps.y ? wrap(y, size.height) : std::clamp(y, 0, size.height - 1);
    Offset shown;
    layout_->shown(column, row, 1, &shown);
    return {{shown.x - (wraps.x ? x : column), shown.y - (wraps.y ? y : row)},
            kept_.at(column, row) ? kept_weight_ : 1};
  }

  void join(const Nodes& nodes, int x, int y, const Offset& place, float* pixel) const {
    Tone away = nodes.at(x, y), own{};
    tones_->add(place.x, place.y, 1, own.data());
    float squares = 0;
    for (size_t c = 0; c < channels_; c++) {
      away[c] -= own[c];
      squares += away[c] * away[c];
    }
    const float apart = std::sqrt(squares), usual = seen_ * tones_->spread(place.x, place.y);
    if (!(apart > usual)) return;
    const float share = usual > 0 ? std::min(1.0f, apart / usual - 1) : 1;
    const ImageInfo& info = resolved_->info();
    const bool vector = info.semantic == Semantic::normal && info.channels >= 3;
    const float long_as = vector ? length(decode_normal(pixel, NormalY::up)) : 0;
    for (size_t c = 0; c < channels_; c++)
      pixel[c] = std::clamp(pixel[c] + share * away[c], std::min(pixel[c], ranges_[c].min),
                            std::max(pixel[c], ranges_[c].max));
    if (vector) {
      encode_normal(normalized(decode_normal(pixel, NormalY::up)) * long_as, NormalY::up, pixel);
      keep_in_range(info, pixel, 1);
    }
  }

  ImagePtr resolved_;
  std::shared_ptr<const FineLayout> layout_;
  std::shared_ptr<const SlowTones> tones_;
  size_t channels_;
  int step_;                  ///< between nodes, in pixels of the output
  float seen_, kept_weight_;  ///< tuning constants
  KeptLookup kept_;
  std::vector<ValueRange> ranges_;  ///< of the exemplar's channels
};

}  // namespace

ImagePtr joined_tones(const ImagePtr& resolved, const ImagePtr& map, std::shared_ptr<const FineLayout> layout,
                      SlowTonesPtr tones, const KeptPixels& kept, const Task& task) {
  task.check();
  Hasher recipe;
  recipe.add("joined tones").add(resolved->digest()).add(map->digest()).add(layout->uv().digest());
  recipe.add(tones->reach());
  if (kept.map) recipe.add(kept.map->digest()).add(kept.x).add(kept.y);
  if (kept.map && kept.holes) recipe.add(kept.holes->digest());
  return Image::computed(resolved->info(), recipe.digest(),
                         std::make_shared<TonePixels>(resolved, map, std::move(layout), std::move(tones), kept));
}

}  // namespace terrazzo
