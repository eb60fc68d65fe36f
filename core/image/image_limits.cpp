#include "core/image/image_limits.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "core/image/pixel_buffer.h"

namespace terrazzo {

namespace {

std::atomic<uint64_t> given_budget{0};
std::atomic<int64_t> given_most_pixels{0}, given_most_bytes{0};
std::atomic<uint64_t> pixels_in_memory{0};

constexpr uint64_t mib = uint64_t{1} << 20;

/// Peak memory of reading: the file's values, of at most 16 bits or kept as they are, plus floats.
constexpr int64_t bytes_per_value = 6;
/// Multiple of the budget for images read into a temporary file, which take disk space and time but little memory.
constexpr int64_t budgets_on_disk = 16;
/// Share of the budget. The rest is for nodes, decoders and encoders.
constexpr uint64_t share_of_pixels = 4, share_of_kept = 8, share_of_a_file = 8;
constexpr uint64_t least_most_bytes = 256 * mib;

uint64_t half_of_memory() {
  static const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGESIZE);
  return pages > 0 && page > 0 ? uint64_t(pages) * uint64_t(page) / 2 : uint64_t{1} << 62;
}

std::string shown(double bytes) {
  double value = bytes / 1024;
  size_t unit = 0;
  constexpr std::array units = {"KiB", "MiB", "GiB", "TiB"};
  for (; value >= 1024 && unit + 1 < units.size(); unit++) value /= 1024;
  return fmt::format("{:.1f} {}", value, units[unit]);
}

/// An option that sets a sufficient size.
std::string as_option(const char* option, uint64_t bytes) {
  return bytes < mib ? fmt::format("{} {}K", option, (bytes + 1023) / 1024)
                     : fmt::format("{} {}M", option, (bytes + mib - 1) / mib);
}

}  // namespace

void set_memory_budget(uint64_t bytes) {
  static const uint64_t usual_kept = PixelBuffer::memory_limit();
  given_budget = bytes;
  PixelBuffer::set_memory_limit(bytes > 0 ? std::min(usual_kept, bytes / share_of_kept) : usual_kept);
}

uint64_t memory_budget() {
  return memory_budget_is_set() ? given_budget.load() : half_of_memory();
}

bool memory_budget_is_set() {
  return given_budget > 0;
}

void set_most_pixels(int64_t pixels) {
  given_most_pixels = pixels;
}

void set_most_bytes(int64_t bytes) {
  given_most_bytes = bytes;
}

void require_pixels_fit(const std::filesystem::path& path, Size size, int channels) {
  const int64_t given = given_most_pixels, pixels = size.area();
  const int64_t per_pixel = bytes_per_value * std::max(1, channels);
  const auto budget = int64_t(memory_budget());
  const int64_t room = memory_budget_is_set() ? budget * budgets_on_disk : budget;
  const int64_t most = given > 0 ? given : room / per_pixel;
  if (pixels <= most) return;
  const std::string takes = fmt::format("reading them takes {}", shown(double(pixels) * double(per_pixel)));
  const std::string why =
      given > 0 ? fmt::format("--max-pixels allows {}", given)
      : memory_budget_is_set()
          ? fmt::format("with --memory {:.0f}M at most {} are read", double(budget) / double(mib), most)
          : fmt::format("{}, and half of this machine's memory is {}", takes, shown(double(budget)));
  throw TooManyPixels(fmt::format(
      "cannot read {}: its header says {}x{}, {} pixels; {}. Scale it down first, or allow it with --max-pixels {}",
      path.string(), size.width, size.height, pixels, why, pixels));
}

void require_bytes_fit(const std::filesystem::path& path, uint64_t bytes) {
  const int64_t given = given_most_bytes;
  const uint64_t most = given > 0 ? uint64_t(given) : std::max(least_most_bytes, memory_budget() / share_of_a_file);
  if (bytes <= most) return;
  throw TooManyPixels(fmt::format(
      "cannot read {}: the file has {} bytes; at most {} are read{}. Scale it down first, or allow it with {}",
      path.string(), bytes, shown(double(most)), given > 0 ? ", as --max-bytes says" : "",
      as_option("--max-bytes", bytes)));
}

void require_decoding_fits(const std::filesystem::path& path, uint64_t bytes, const char* kind) {
  if (!memory_budget_is_set() || bytes <= memory_budget()) return;
  throw TooManyPixels(fmt::format(
      "cannot read {} with --memory {:.0f}M: {}, so all of it has to be in memory while it is decoded, {}. Give {}, or "
      "save it as a plain PNG, TIFF or EXR file, which are read by rows",
      path.string(), double(memory_budget()) / double(mib), kind, shown(double(bytes)), as_option("--memory", bytes)));
}

PixelRoom::PixelRoom(uint64_t bytes) : bytes_(bytes) {
  pixels_in_memory += bytes;
}

PixelRoom::PixelRoom(PixelRoom&& other) noexcept : bytes_(std::exchange(other.bytes_, 0)) {}

PixelRoom::~PixelRoom() {
  pixels_in_memory -= bytes_;
}

bool PixelRoom::has(uint64_t bytes) {
  return pixels_in_memory + bytes <= memory_budget() / share_of_pixels;
}

}  // namespace terrazzo
