#pragma once

#include <atomic>
#include <memory>
#include <mutex>

#include "core/image/image.h"
#include "core/image/pull_plan.h"

/// Images computed on demand. They form a directed acyclic graph whose edges lead from an image to its sources.
///
/// Regions are not pulled by recursion: that would compute a region again for every reader, and the stack would grow
/// with the length of a chain. Instead a PullPlan (core/image/pull_plan.h) first determines, from the result back to
/// the sources, which regions of each image are needed, and then computes each once, from the sources forward. As in
/// Halide and libvips, an operation states the regions it reads separately from how it computes them.
///
/// Neighbourhood operations enlarge regions from image to image, images may have many readers, and chains may be of any
/// length. Some images therefore keep their pixels: the first read computes them as a whole, into memory or a scratch
/// file, and later reads need no sources. They are chosen while the graph is built, such that no pull spans more than
/// `longest_pull()` images, strips overlap little, and images with many readers are computed once. A chain of n images
/// takes time linear in n and keeps few of them in memory.
namespace terrazzo {

/// The most computed images that a pull spans, except for images with more sources than that.
int longest_pull();

/// The pixels of one computed image. Thread-safe.
class ComputedPixels final : public PulledImage {
 public:
  static std::shared_ptr<const ComputedPixels> make(Size size, int channels, Operation operation);
  /// The pixels of a computed image; null for other images.
  static std::shared_ptr<const ComputedPixels> of(const Image& image);

  /// Throws Cancelled if the thread's task is cancelled (see CurrentTask).
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
  int pull_length_ = 1;  ///< how many images a pull spans
  mutable std::atomic<int> readers_{0};
  mutable std::atomic<bool> to_be_kept_{false};
  mutable std::atomic<bool> is_kept_{false};
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Operation> operation_;  ///< guarded by mutex_
  mutable std::shared_ptr<Filling> filling_;            ///< guarded by mutex_ until is_kept_
};

}  // namespace terrazzo
