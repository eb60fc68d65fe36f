#include "core/node/stored_pixels.h"

#include <algorithm>
#include <mutex>

#include <fmt/format.h>

namespace terrazzo {

namespace {

/// Rows whose blocks are kept, so that adjacent tiles do not decode the same blocks again.
constexpr uint64_t kept_rows = 256;
constexpr uint64_t least_kept_blocks = 4, most_kept_blocks = 64;

class StoredPixels : public PixelSource {
 public:
  StoredPixels(std::shared_ptr<const BlockFile> file, uint32_t stream, Size size, int channels)
      : file_(std::move(file)),
        stream_(file_->streams()[stream]),
        row_(uint64_t(size.width) * uint64_t(channels)),
        channels_(channels),
        kept_blocks_(std::clamp(kept_rows * row_ / samples_per_block + 2, least_kept_blocks, most_kept_blocks)) {}

  void read(const Rect& r, float* out) const override {
    const uint64_t count = uint64_t(r.width) * uint64_t(channels_);
    if (count == row_) return read_run(uint64_t(r.y) * row_, count * uint64_t(r.height), out);
    for (int y = 0; y < r.height; y++)
      read_run(uint64_t(r.y + y) * row_ + uint64_t(r.x) * uint64_t(channels_), count, out + uint64_t(y) * count);
  }

 private:
  /// A block decoded by its first reader while others wait.
  struct Slot {
    std::mutex decoding;
    bool decoded = false;
    RawBlock block;
  };
  struct Kept {
    uint64_t block;
    uint64_t last_use;
    std::shared_ptr<Slot> slot;
  };

  void read_run(uint64_t at, uint64_t count, float* out) const {
    while (count > 0) {
      const uint64_t within = at % samples_per_block;
      const uint64_t n = std::min(count, samples_per_block - within);
      const std::shared_ptr<Slot> slot = decoded_slot(at / samples_per_block);
      const RawBlock& b = slot->block;
      decode_samples(b.coding, b.bytes.data() + within * uint64_t(sample_bytes(b.coding)), n, out);
      at += n;
      out += n;
      count -= n;
    }
  }

  std::shared_ptr<Slot> decoded_slot(uint64_t block) const {
    std::shared_ptr<Slot> slot = kept_slot(block);
    const std::lock_guard lock(slot->decoding);
    if (!slot->decoded) {
      try {
        slot->block = file_->read(stream_.blocks[block]);
      } catch (const DamagedFile& e) {
        throw DamagedFile(fmt::format("{} is damaged: {}", file_->path().string(), e.what()));
      }
      slot->decoded = true;
    }
    return slot;
  }

  std::shared_ptr<Slot> kept_slot(uint64_t block) const {
    const std::lock_guard lock(mutex_);
    clock_++;
    for (Kept& k : kept_)
      if (k.block == block) {
        k.last_use = clock_;
        return k.slot;
      }
    Kept fresh{block, clock_, std::make_shared<Slot>()};
    if (kept_.size() < kept_blocks_) return kept_.emplace_back(std::move(fresh)).slot;
    auto oldest = std::min_element(kept_.begin(), kept_.end(),
                                   [](const Kept& a, const Kept& b) { return a.last_use < b.last_use; });
    *oldest = std::move(fresh);
    return oldest->slot;
  }

  std::shared_ptr<const BlockFile> file_;
  const BlockStream& stream_;
  uint64_t row_;
  int channels_;
  uint64_t kept_blocks_;
  mutable std::mutex mutex_;
  mutable uint64_t clock_ = 0;
  mutable std::vector<Kept> kept_;
};

}  // namespace

std::shared_ptr<const PixelSource> stored_pixels(std::shared_ptr<const BlockFile> file, uint32_t stream, Size size,
                                                 int channels) {
  return std::make_shared<StoredPixels>(std::move(file), stream, size, channels);
}

}  // namespace terrazzo
