#pragma once

#include <cstdint>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/geometry.h"

/// Limits on the memory that images take and on the size of image files: a small file can decode to more pixels than
/// fit in memory. All settings apply to the whole process; make them before images are read. Thread-safe.
namespace terrazzo {

/// An image file has too many pixels or bytes.
class TooManyPixels : public Error {
 public:
  using Error::Error;
};

/// Sets the memory budget for images in bytes; 0: half of this machine's memory. Also limits the memory for kept
/// computed pixels.
void set_memory_budget(uint64_t bytes);
/// In bytes; half of this machine's memory if none is set.
uint64_t memory_budget();
bool memory_budget_is_set();

/// Sets the most pixels of one image; 0: as many as fit into half of this machine's memory, or into 16 times the budget
/// if one is set, since large images are then read strip by strip into a temporary file.
void set_most_pixels(int64_t pixels);
/// Sets the most bytes of one image file; 0: an eighth of the budget, but at least 256 MiB.
void set_most_bytes(int64_t bytes);

/// Throws TooManyPixels unless an image of this size may be read.
void require_pixels_fit(const std::filesystem::path& path, Size size, int channels);
/// Throws TooManyPixels unless a file of this size in bytes may be read.
void require_bytes_fit(const std::filesystem::path& path, uint64_t bytes);
/// The same for an image whose decoder holds `bytes` at once. `kind`: why it cannot be decoded row by row, "it is
/// interlaced". Never throws if no budget is set.
void require_decoding_fits(const std::filesystem::path& path, uint64_t bytes, const char* kind);

/// A reservation of memory for an image's pixels, from the quarter of the budget that all images share. The destructor
/// releases it.
class PixelRoom {
 public:
  PixelRoom() = default;
  PixelRoom(PixelRoom&& other) noexcept;
  PixelRoom& operator=(PixelRoom&&) = delete;
  ~PixelRoom();
  /// Reserves unconditionally, even beyond the limit.
  explicit PixelRoom(uint64_t bytes);
  /// Whether `bytes` more are available. Other threads may reserve them at any time.
  static bool has(uint64_t bytes);

 private:
  uint64_t bytes_ = 0;
};

}  // namespace terrazzo
