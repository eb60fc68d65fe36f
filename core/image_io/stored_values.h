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

/// Corrects decoded values: inversion, premultiplied alpha, non-finite pixels. Not thread-safe.
namespace terrazzo {

/// What must be known of an image before its values are read.
struct StoredMeaning {
  FormatFacts facts{};
  Rect stored;  ///< in the image's coordinates
  int channels = 1;
  bool is_float = false;              ///< values may be non-finite
  double integer_range = 0;           ///< for 32-bit integers, the stored value that is decoded as 1; else 0
  bool is_colour = false;             ///< the last of two or four channels is alpha
  bool may_be_premultiplied = false;  ///< by convention of the format; files do not state it
  bool can_be_averaged = true;        ///< see core/image/pixel_space.h
};

/// Corrects values as they arrive, and collects what can only be judged once all have arrived.
class StoredValues {
 public:
  explicit StoredValues(StoredMeaning meaning) : meaning_(std::move(meaning)) {}

  /// Corrects the next values, whole pixels in file order: undoes inversion and unpremultiplies colours. 16-bit values
  /// are halfs if `is_float`, else integers.
  void mend(std::span<uint8_t> values);
  void mend(std::span<uint16_t> values);
  void mend(std::span<float> values);

  /// The alpha of a colour image is 0 everywhere.
  bool is_invisible() const { return has_alpha() && meaning_.is_colour && pixels_ > 0 && !any_alpha_; }

  /// A non-finite channel of a pixel, and its replacement.
  struct Hole {
    int x = 0, y = 0;  ///< in stored pixels
    int channel = 0;
    float value = 0;
  };
  /// All non-finite values. The replacement is the mean of the finite values in the smallest square around the pixel
  /// that contains any; in masks the first of them. `read` returns stored pixels as floats. Throws Error with a clause
  /// if there are too many, or if finite values are too far away.
  std::vector<Hole> filled_holes(const std::function<void(const Rect&, float*)>& read) const;

  /// A note for the user, as a clause.
  struct Remark {
    std::string text{};
    bool is_loss = false;  ///< about lost values
  };
  /// Notes about all values. Throws Error with a clause if the values seem to be counts or ids.
  std::vector<Remark> remarks() const;

 private:
  bool has_alpha() const { return meaning_.channels % 2 == 0; }
  template <typename T, typename Traits>
  void mend_as(std::span<T> values, const Traits& traits);
  void note_hole(int64_t pixel, int channel);

  StoredMeaning meaning_;
  int64_t pixels_ = 0;          ///< received so far
  int64_t without_colour_ = 0;  ///< pixels with premultiplied colours and alpha 0
  int64_t brighter_ = 0;        ///< pixels with colours larger than alpha
  int64_t translucent_ = 0;     ///< pixels with alpha between 0 and 1
  bool any_alpha_ = false;
  std::array<float, 4> largest_{};  ///< of each channel
  int64_t holed_pixels_ = 0, last_holed_ = -1;
  std::vector<Hole> holes_;
};

}  // namespace terrazzo
