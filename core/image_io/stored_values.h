#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/base/geometry.h"
#include "core/image/image.h"
#include "core/image_io/format_facts.h"

/// From the values that a decoder gives to those that the file means. Not thread-safe.
namespace terrazzo {

/// What is to be known of an image before its values are read.
struct StoredMeaning {
  FormatFacts facts{};
  Rect stored;  ///< in the image's coordinates
  int channels = 1;
  bool is_float = false;              ///< values may be not finite
  double integer_range = 0;           ///< the largest value that came as 1, of 32-bit integers; else 0
  bool is_colour = false;             ///< an even number of channels ends with alpha
  bool may_be_premultiplied = false;  ///< by convention of the format, which files do not say
  bool can_be_averaged = true;        ///< see core/image/pixel_space.h
};

/// Mends values as they come, and remembers what can only be judged when all have come.
class StoredValues {
 public:
  explicit StoredValues(StoredMeaning meaning) : meaning_(std::move(meaning)) {}

  /// The next values, whole pixels in the order of the file: inverts what is stored inverted, and divides colours by
  /// the alpha that they are multiplied by. Halfs are told from 16-bit integers by `is_float`.
  void mend(std::span<uint8_t> values);
  void mend(std::span<uint16_t> values);
  void mend(std::span<float> values);

  /// Alpha of colours is 0 everywhere: nothing would be seen.
  bool is_invisible() const { return has_alpha() && meaning_.is_colour && pixels_ > 0 && !any_alpha_; }

  /// A channel of a pixel that is not finite, and what it should be.
  struct Hole {
    int x = 0, y = 0;  ///< of the stored pixels
    int channel = 0;
    float value = 0;
  };
  /// Those that are not finite, each with the mean of the finite values around it (in masks the first of them): those
  /// of the smallest square that holds any. `read` gives stored pixels as floats. Throws Error with a part of a
  /// sentence if there are too many, or too far from finite ones.
  std::vector<Hole> filled_holes(const std::function<void(const Rect&, float*)>& read) const;

  /// What the user should know, a part of a sentence.
  struct Remark {
    std::string text{};
    bool is_loss = false;  ///< of values
  };
  /// Throws Error with a part of a sentence if the values are no shades but counts or ids.
  std::vector<Remark> remarks() const;

 private:
  bool has_alpha() const { return meaning_.channels % 2 == 0; }
  template <typename T, typename Traits>
  void mend_as(std::span<T> values, const Traits& traits);
  void note_hole(int64_t pixel, int channel);

  StoredMeaning meaning_;
  int64_t pixels_ = 0;          ///< that have come
  int64_t without_colour_ = 0;  ///< alpha is 0, and colours are multiplied by it
  int64_t brighter_ = 0;        ///< colours are larger than alpha
  int64_t translucent_ = 0;     ///< alpha is between 0 and 1
  bool any_alpha_ = false;
  std::array<float, 4> largest_{};  ///< of each channel
  int64_t holed_pixels_ = 0, last_holed_ = -1;
  std::vector<Hole> holes_;
};

}  // namespace terrazzo
