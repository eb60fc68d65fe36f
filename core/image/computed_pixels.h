#pragma once

#include <atomic>
#include <memory>
#include <mutex>

#include "core/image/image.h"
#include "core/image/pull_plan.h"

/// Images that are computed when they are asked for, and what that costs. Such images make up a graph without cycles;
/// its edges lead from an image to those that it is made from.
///
/// A region is not pulled through the graph by calls that call each other: it would be computed anew for every reader,
/// and there would be as many calls on the stack as images in a row. A PullPlan (core/image/pull_plan.h) first asks
/// back to front what is needed of each image, then computes that, once, front to back. As in Halide and libvips, what
/// an image needs is told apart from how it is made.
///
/// Regions grow from image to image where operations look around them, images have many readers, and rows of images can
/// be of any length. So some images on the way keep their pixels: they are computed as a whole when somebody needs them
/// first, into memory or a scratch file, and from then on need no sources. Which ones is decided while the graph is
/// built, so that no pull goes back over more than `longest_pull()` images, none spends much on the surroundings of its
/// strips, and none is computed for many readers. A chain of n images costs time linear in n, and holds few of them.
namespace terrazzo {

/// How many computed images a pull goes over at most, but for images with more sources than that.
int longest_pull();

/// The pixels of one computed image. Thread-safe.
class ComputedPixels final : public PulledImage {
 public:
  static std::shared_ptr<const ComputedPixels> make(Size size, int channels, Operation operation);
  /// The source of an image that is computed; null for others.
  static std::shared_ptr<const ComputedPixels> of(const Image& image);

  /// Stops with Cancelled when the task that the thread works for is cancelled.
  void read(const Rect& region, float* out) const override;

  Size size() const override { return size_; }
  int channels() const override { return channels_; }
  std::shared_ptr<const Operation> operation() const override;
  bool to_be_kept() const override { return to_be_kept_; }
  void keep() const override;

 private:
  struct Filling;
  ComputedPixels(Size size, int channels, Operation operation);
  void choose_kept();
  int rows_at_once(PullPlan& plan, const Rect& region) const;
  std::shared_ptr<Filling> filling() const;
  void compute_strip(Filling& filling, int strip) const;
  void help(Filling& filling) const;
  void await(Filling& filling) const;
  void finish() const;
  void give_up(const std::shared_ptr<Filling>& filling) const;

  const Size size_;
  const int channels_;
  int pull_length_ = 1;  ///< how many images a pull goes over
  mutable std::atomic<int> readers_{0};
  mutable std::atomic<bool> to_be_kept_{false};
  mutable std::atomic<bool> is_kept_{false};
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Operation> operation_;  ///< guarded by mutex_
  mutable std::shared_ptr<Filling> filling_;            ///< guarded by mutex_ until is_kept_
};

}  // namespace terrazzo
