#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/geometry.h"

namespace terrazzo {

/// All pixels of an image, written row by row: in memory up to memory_limit(), beyond it in a scratch file, or in
/// memory after all if the disk is full. Thread-safe for different rows, and for reading once all are written.
class PixelBuffer {
 public:
  PixelBuffer(Size size, int channels);
  ~PixelBuffer();
  PixelBuffer(const PixelBuffer&) = delete;
  PixelBuffer& operator=(const PixelBuffer&) = delete;

  /// Writable memory of row `y` and the rows below it; null if the pixels are in the file.
  float* rows_in_memory(int y) { return in_memory_.empty() ? nullptr : &in_memory_[size_t(y) * row_]; }
  void write_rows(int y, int rows, const float* pixels);
  void read(const Rect& region, float* out) const;

  /// The bytes that pixel buffers take in memory and may take, summed over all images. A new limit applies to future
  /// buffers.
  static uint64_t memory_in_use();
  static uint64_t memory_limit();
  static void set_memory_limit(uint64_t bytes);

 private:
  uint64_t bytes() const { return uint64_t(row_) * uint64_t(height_) * sizeof(float); }
  size_t row_;  ///< in values
  int height_;
  int channels_;
  std::vector<float> in_memory_;
  std::optional<uint64_t> in_file_;  ///< offset of the pixels
};

}  // namespace terrazzo
