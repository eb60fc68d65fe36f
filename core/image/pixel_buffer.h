#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/geometry.h"

namespace terrazzo {

/// All pixels of an image, written row by row: in memory as long as there is little of it in use for such pixels, else
/// in a scratch file; and in memory again if there is no room on disk. Thread-safe for different rows, and for reading
/// once all are written.
class PixelBuffer {
 public:
  PixelBuffer(Size size, int channels);
  ~PixelBuffer();
  PixelBuffer(const PixelBuffer&) = delete;
  PixelBuffer& operator=(const PixelBuffer&) = delete;

  /// Where row `y` and those below it lie, to be written to; null if they lie in the file.
  float* rows_in_memory(int y) { return in_memory_.empty() ? nullptr : &in_memory_[size_t(y) * row_]; }
  void write_rows(int y, int rows, const float* pixels);
  void read(const Rect& region, float* out) const;

  /// How many bytes of memory such pixels take, in all images together, and may take; the limit is for those to come.
  static uint64_t memory_in_use();
  static uint64_t memory_limit();
  static void set_memory_limit(uint64_t bytes);

 private:
  uint64_t bytes() const { return uint64_t(row_) * uint64_t(height_) * sizeof(float); }
  size_t row_;  ///< values
  int height_;
  int channels_;
  std::vector<float> in_memory_;
  std::optional<uint64_t> in_file_;  ///< where they begin
};

}  // namespace terrazzo
