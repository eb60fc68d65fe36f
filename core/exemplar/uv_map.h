#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/hash.h"
#include "core/exemplar/fingerprint.h"

namespace terrazzo {

/// The exemplar pixel that an output pixel shows.
struct ExemplarPixel {
  uint16_t x = 0;
  uint16_t y = 0;
  bool operator==(const ExemplarPixel&) const = default;
};

/// What has no border: beyond one side lies the other.
struct UvWraps {
  bool x = false;         ///< the output, from right to left
  bool y = false;         ///< the output, from bottom to top
  bool exemplar = false;  ///< the exemplar, in both directions
  bool operator==(const UvWraps&) const = default;
};

class UvMap;
using UvMapPtr = std::shared_ptr<const UvMap>;

/// For each output pixel the exemplar pixel it samples; integer, exact. The one thing synthesis decides: every map of
/// a material is resolved through it, so none can drift from another. Exemplars are at most 65536 pixels a side.
/// Immutable.
class UvMap {
 public:
  /// `pixels` row by row; all lie within `exemplar`, the size of the exemplar that was analysed. `fingerprint`: of its
  /// maps; null if it is not known.
  static UvMapPtr make(Size size, Size exemplar, std::vector<ExemplarPixel> pixels, UvWraps wraps = {},
                       FingerprintPtr fingerprint = nullptr);

  Size size() const { return size_; }
  Size exemplar() const { return exemplar_; }
  UvWraps wraps() const { return wraps_; }
  /// Copies a region that lies inside the map, row by row. Thread-safe.
  void read(const Rect& region, ExemplarPixel* out) const;
  const std::vector<ExemplarPixel>& pixels() const { return pixels_; }
  ExemplarPixel at(int x, int y) const { return pixels_[size_t(y) * size_.width + x]; }
  const FingerprintPtr& fingerprint() const { return fingerprint_; }  ///< null: not known
  const Digest& digest() const { return digest_; }

 private:
  UvMap() = default;
  Size size_;
  Size exemplar_;
  UvWraps wraps_;
  std::vector<ExemplarPixel> pixels_;
  FingerprintPtr fingerprint_;
  Digest digest_;
};

}  // namespace terrazzo
