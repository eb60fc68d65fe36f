#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/hash.h"
#include "core/exemplar/elements.h"
#include "core/exemplar/fingerprint.h"
#include "core/exemplar/repeats.h"

namespace terrazzo {

/// An appearance vector: principal components of a pixel's 5x5 neighbourhood over all weighted channels, as
/// integers so that distances are exact and the same on every machine. Unused dimensions are 0. Components lie in
/// [-appearance_limit, appearance_limit]: the squared distance of two windows of 25 vectors fits 32 bits.
inline constexpr int appearance_dimensions = 8;
inline constexpr int appearance_limit = 1600;
using AppearanceVector = std::array<int16_t, appearance_dimensions>;
static_assert(25LL * appearance_dimensions * (2LL * appearance_limit) * (2LL * appearance_limit) < (1LL << 32));

/// One level of the exemplar pyramid in appearance space.
struct AppearanceLevel {
  Size size;
  std::vector<AppearanceVector> vectors;  ///< size.area(), row by row
  std::vector<uint8_t> usable{};          ///< 1 where synthesis may take a pixel, one per vector; empty: everywhere
  /// The PCA basis: neighbourhood (window * channels values, weighted by a Gaussian) minus `mean`, projected on each of
  /// `dimensions` rows of `basis`, times `scale`, rounded. Lets other images be brought into this space.
  int dimensions = 0;
  /// Levels at which guidance has no weight have the features' channels only.
  std::vector<float> mean;   ///< window area * channels
  std::vector<float> basis;  ///< dimensions rows of window area * channels
  double scale = 1;
  double retained = 1;  ///< fraction of the variance the kept dimensions explain
};

class Appearance;
using AppearancePtr = std::shared_ptr<const Appearance>;

/// An exemplar in appearance space (Lefebvre & Hoppe, Appearance-space texture synthesis, 2006): a Gaussian pyramid,
/// finest level first, each level with a PCA of its own. Of an exemplar of streaks (Repeats::streaks) all levels are
/// shortened along them. Immutable.
class Appearance {
 public:
  /// `fingerprint`: of the exemplar's maps; null if it is not known. `exemplar`: its size; 0x0 for that of the finest
  /// level, which it has unless streaks were shortened.
  static AppearancePtr make(std::vector<AppearanceLevel> levels, int channels, bool wraps, const Repeats& repeats = {},
                            FingerprintPtr fingerprint = nullptr, ElementsPtr elements = nullptr, Size exemplar = {});

  const std::vector<AppearanceLevel>& levels() const { return levels_; }
  Size size() const { return size_; }                                 ///< of the exemplar
  int channels() const { return channels_; }                          ///< features and guidance channels that went in
  bool wraps() const { return wraps_; }                               ///< the exemplar tiles in x and y
  const Repeats& repeats() const { return repeats_; }                 ///< how the exemplar repeats, if it does
  const Lattice& lattice() const { return repeats_.lattice; }         ///< that of all of it or of most
  const FingerprintPtr& fingerprint() const { return fingerprint_; }  ///< null: not known
  const ElementsPtr& elements() const { return elements_; }           ///< null: not known
  const Digest& digest() const { return digest_; }

 private:
  Appearance() = default;
  Size size_;
  std::vector<AppearanceLevel> levels_;
  int channels_ = 0;
  bool wraps_ = false;
  Repeats repeats_;
  FingerprintPtr fingerprint_;
  ElementsPtr elements_;
  Digest digest_;
};

/// The most similar pixels that a pixel can have.
inline constexpr int most_similar = 8;

/// Exemplar positions with similar surroundings, for every pixel of one level.
struct SimilarSets {
  int per_pixel = 0;                ///< at most most_similar; 0: the level has no sets
  std::vector<uint32_t> positions;  ///< y * width + x; size.area() * per_pixel, best first, row by row
};

class Index;
using IndexPtr = std::shared_ptr<const Index>;

/// All that synthesis needs: an appearance and, per level, each pixel's similar set. Immutable.
class Index {
 public:
  static IndexPtr make(AppearancePtr appearance, std::vector<SimilarSets> levels);

  const AppearancePtr& appearance() const { return appearance_; }
  const std::vector<SimilarSets>& levels() const { return levels_; }
  const Digest& digest() const { return digest_; }

 private:
  Index() = default;
  AppearancePtr appearance_;
  std::vector<SimilarSets> levels_;
  Digest digest_;
};

}  // namespace terrazzo
