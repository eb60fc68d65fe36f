#pragma once

#include <cstdint>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/geometry.h"

/// How much of this machine images may take, and how large an image file may be: a small file can stand for a picture
/// that no memory holds. All settings are for the whole process; make them before images are read. Thread-safe.
namespace terrazzo {

/// An image file that is too large, in pixels or in bytes.
class TooManyPixels : public Error {
 public:
  using Error::Error;
};

/// The bytes of memory that the process is to stay within, as far as images decide that; 0: half of this machine's
/// memory. Also sets how much of it computed pixels that are kept may take.
void set_memory_budget(uint64_t bytes);
/// Half of this machine's memory if none is set.
uint64_t memory_budget();
bool memory_budget_is_set();

/// At most so many pixels in one image; 0: as many as fit into half of this machine's memory, or, as large images are
/// read strip by strip into a temporary file, into 16 times the budget if one is set.
void set_most_pixels(int64_t pixels);
/// At most so many bytes in one image file; 0: an eighth of the budget, but at least 256 MiB.
void set_most_bytes(int64_t bytes);

/// Throws TooManyPixels unless an image of this size may be read.
void require_pixels_fit(const std::filesystem::path& path, Size size, int channels);
/// Throws TooManyPixels unless a file of so many bytes may be read.
void require_bytes_fit(const std::filesystem::path& path, uint64_t bytes);
/// The same for an image whose decoder holds `bytes` of it at once. `kind`: what keeps it from being decoded row by
/// row, "it is interlaced". Lets everything through unless a budget is set.
void require_decoding_fits(const std::filesystem::path& path, uint64_t bytes, const char* kind);

/// Room for the pixels of an image in memory, out of a quarter of the budget that all of them share; given back with
/// the object.
class PixelRoom {
 public:
  PixelRoom() = default;
  PixelRoom(PixelRoom&& other) noexcept;
  PixelRoom& operator=(PixelRoom&&) = delete;
  ~PixelRoom();
  /// Room that is taken whether there is as much or not.
  explicit PixelRoom(uint64_t bytes);
  /// Whether so many bytes more fit in. The answer holds for a moment only, as other threads take room too.
  static bool has(uint64_t bytes);

 private:
  uint64_t bytes_ = 0;
};

}  // namespace terrazzo
