#include "core/image/image_limits.h"

#include <algorithm>
#include <atomic>

#include <fmt/format.h>
#include <unistd.h>

namespace terrazzo {

namespace {

std::atomic<int64_t> given_most{0};

/// What reading takes at its peak: the file's values, of 16 bits at most or kept as they are, and the same as floats.
constexpr int64_t bytes_per_value = 6;

/// The budget of a run for which none is given.
int64_t half_of_memory() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGESIZE);
  return pages > 0 && page > 0 ? int64_t{pages} * page / 2 : INT64_MAX;
}

}  // namespace

void set_most_pixels(int64_t pixels) {
  given_most = pixels;
}

void require_pixels_fit(const std::filesystem::path& path, Size size, int channels) {
  constexpr double gib = 1 << 30;
  const int64_t given = given_most, pixels = size.area();
  const int64_t per_pixel = bytes_per_value * std::max(1, channels);
  const int64_t most = given > 0 ? given : half_of_memory() / per_pixel;
  if (pixels <= most) return;
  const std::string why =
      given > 0 ? fmt::format("--max-pixels allows {}", given)
                : fmt::format("reading them takes {:.1f} GiB, and half of this machine's memory is {:.1f}",
                              double(pixels) * double(per_pixel) / gib, double(half_of_memory()) / gib);
  throw TooManyPixels(fmt::format(
      "cannot read {}: its header says {}x{}, {} pixels; {}. Scale it down first, or allow it with --max-pixels {}",
      path.string(), size.width, size.height, pixels, why, pixels));
}

}  // namespace terrazzo
