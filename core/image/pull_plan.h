#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/image/image.h"

namespace terrazzo {

/// The interface of computed images to pull plans, see core/image/computed_pixels.h. Thread-safe.
class PulledImage : public PixelSource {
 public:
  virtual Size size() const = 0;
  virtual int channels() const = 0;
  /// Null once the pixels are kept.
  virtual std::shared_ptr<const Operation> operation() const = 0;
  /// Whether its pixels are kept once they are computed.
  virtual bool to_be_kept() const = 0;
  /// Computes and keeps all pixels. Sources that are to be kept must already be. Concurrent callers share the work.
  virtual void keep() const = 0;
};

/// What to compute, and in which order, to pull regions of a computed image: the image itself and its sources, back to
/// images whose pixels are available. Not thread-safe; any number of plans may use the same images.
class PullPlan {
 public:
  /// Where a plan ends.
  enum class Until : uint8_t {
    kept,        ///< at images whose pixels are kept
    to_be_kept,  ///< and those whose pixels will be
  };
  /// `image` must outlive the plan.
  PullPlan(const PulledImage& image, Until until);

  /// The number of images that it computes.
  size_t length() const { return steps_.size(); }
  /// Whether it computes any image that is to be kept.
  bool passes_by_kept() const;
  /// Computes and keeps the pixels of all images that are to be kept, one after the other. Consumes the plan: each
  /// image is released as soon as it is done.
  void keep_pixels();
  /// Computes a region of the image.
  void pull(const Rect& region, float* out);
  /// The most values that a pull of the region computes for any one image. Values read from disk count a quarter.
  int64_t most_values(const Rect& region);
  /// The work of pulling the image in strips of `rows` rows, relative to computing every image once.
  double work_by_strips(int rows);

 private:
  struct Step {
    std::shared_ptr<const PulledImage> image;
    std::shared_ptr<const Operation> operation;
    std::vector<int> sources;   ///< index of their steps; -1 for sources that are read directly
    std::vector<Rect> parts{};  ///< the needed parts of the image
    std::vector<PixelBlock> blocks{};
    int readers = 0;       ///< number of reads by other steps
    int open_readers = 0;  ///< reads still to come
  };

  /// Rereading the overlap of strips takes longer than recomputing it.
  static constexpr int64_t read_for_one = 4;

  static int64_t values_read(const Step& step);
  void order(const PulledImage& image, Until until);
  void demand(const Rect& region);
  void compute(Step& step, float* out);
  void let_go(const Step& step);
  std::vector<Step> steps_;  ///< every image after its sources
};

}  // namespace terrazzo
