#pragma once

#include <memory>
#include <vector>

#include "core/image/computed_pixels.h"

namespace terrazzo {

/// What has to be computed, and in which order, to pull regions of a computed image: the image itself and all those it
/// is made from, up to ones whose pixels can be had. For one thread; any number of plans may use the same images.
class PullPlan {
 public:
  /// Where a plan ends.
  enum class Until : uint8_t {
    kept,        ///< at images whose pixels are kept
    to_be_kept,  ///< and those whose pixels will be
  };
  /// `image` must outlive the plan.
  PullPlan(const ComputedPixels& image, Until until);

  /// How many images it computes.
  size_t length() const { return steps_.size(); }
  /// Whether it computes images whose pixels are to be kept.
  bool passes_by_kept() const;
  /// Computes and keeps the images whose pixels are to be kept, one after the other. The plan is used up by that: it
  /// lets go of each image as soon as it is done with.
  void keep_pixels();
  /// Computes a region of the image.
  void pull(const Rect& region, float* out);
  /// The most values that it computes of one image for a region, or a quarter of those that it reads from disk for one.
  int64_t most_values(const Rect& region);
  /// How many times more work it is to pull the image by strips of so many rows than to compute every image once.
  double work_by_strips(int rows);

 private:
  struct Step {
    std::shared_ptr<const ComputedPixels> image;
    std::shared_ptr<const Operation> operation;
    std::vector<int> sources;   ///< their steps; -1 for what is read as it is
    std::vector<Rect> parts{};  ///< that are needed of it
    std::vector<PixelBlock> blocks{};
    int readers = 0;       ///< among the steps, counted as often as they read it
    int open_readers = 0;  ///< that have not been computed yet
  };

  /// Reading again what strips have in common takes longer than computing it again.
  static constexpr int64_t read_for_one = 4;

  static int64_t values_read(const Step& step);
  void order(const ComputedPixels& image, Until until);
  void demand(const Rect& region);
  void compute(Step& step, float* out);
  void let_go(const Step& step);
  std::vector<Step> steps_;  ///< every image after its sources
};

}  // namespace terrazzo
