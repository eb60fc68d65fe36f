#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/image/image.h"

namespace terrazzo {

/// A computed image as a pull sees it, see core/image/computed_pixels.h. Thread-safe.
class PulledImage : public PixelSource {
 public:
  virtual Size size() const = 0;
  virtual int channels() const = 0;
  /// Null once the pixels are kept.
  virtual std::shared_ptr<const Operation> operation() const = 0;
  /// Whether its pixels are to be kept, whether they are or not yet.
  virtual bool to_be_kept() const = 0;
  /// Computes all pixels and keeps them. Those that it is made from and that are to be kept must be, already. Threads
  /// that ask for the same work together.
  virtual void keep() const = 0;
};

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
  PullPlan(const PulledImage& image, Until until);

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
    std::shared_ptr<const PulledImage> image;
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
  void order(const PulledImage& image, Until until);
  void demand(const Rect& region);
  void compute(Step& step, float* out);
  void let_go(const Step& step);
  std::vector<Step> steps_;  ///< every image after its sources
};

}  // namespace terrazzo
