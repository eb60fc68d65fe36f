#include "core/image/pixel_buffer.h"

#include <algorithm>
#include <atomic>

#include "core/file/scratch_file.h"

namespace terrazzo {

namespace {

/// One map of 4096x4096 pixels and 4 channels: a small part of a run's memory.
constexpr uint64_t usual_limit = uint64_t{256} << 20;

std::atomic<uint64_t> in_use{0};
std::atomic<uint64_t> limit{usual_limit};

}  // namespace

PixelBuffer::PixelBuffer(Size size, int channels)
    : row_(size_t(size.width) * channels), height_(size.height), channels_(channels) {
  const bool fits = in_use.fetch_add(bytes()) + bytes() <= limit;
  if (!fits) in_file_ = ScratchFile::shared().take(bytes());
  if (in_file_) {
    in_use -= bytes();
    return;
  }
  try {
    in_memory_.resize(row_ * size_t(height_));
  } catch (...) {
    in_use -= bytes();
    throw;
  }
}

PixelBuffer::~PixelBuffer() {
  if (in_file_)
    ScratchFile::shared().give_back(*in_file_, bytes());
  else
    in_use -= bytes();
}

void PixelBuffer::write_rows(int y, int rows, const float* pixels) {
  const size_t first = size_t(y) * row_, count = size_t(rows) * row_;
  if (in_file_)
    ScratchFile::shared().write(*in_file_ + first * sizeof(float), pixels, count * sizeof(float));
  else
    std::copy_n(pixels, count, &in_memory_[first]);
}

void PixelBuffer::read(const Rect& region, float* out) const {
  const size_t values = size_t(region.width) * channels_;
  const bool whole_rows = values == row_;
  const int reads = whole_rows ? 1 : region.height;
  const size_t count = whole_rows ? values * size_t(region.height) : values;
  for (int i = 0; i < reads; i++, out += count) {
    const size_t first = size_t(region.y + i) * row_ + size_t(region.x) * channels_;
    if (in_file_)
      ScratchFile::shared().read(*in_file_ + first * sizeof(float), out, count * sizeof(float));
    else
      std::copy_n(&in_memory_[first], count, out);
  }
}

uint64_t PixelBuffer::memory_in_use() {
  return in_use;
}

uint64_t PixelBuffer::memory_limit() {
  return limit;
}

void PixelBuffer::set_memory_limit(uint64_t bytes) {
  limit = bytes;
}

}  // namespace terrazzo
