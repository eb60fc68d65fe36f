#include "core/image_io/stored_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Imath/half.h>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct StoredValuesTuning {
  double most_unfinite = 0.05;
  int largest_hole = 16;
};
const Tunable<StoredValuesTuning> stored_values_tuning(
    "stored_values", {
                         {&StoredValuesTuning::most_unfinite, "most_unfinite", "of the pixels",
                          "that may be not finite. Higher: maps that are mostly made up are read; lower: "
                          "renders with a few wild pixels are refused",
                          "not measured: what is filled in should not show", 0, 1},
                         {&StoredValuesTuning::largest_hole, "largest_hole", "pixels",
                          "from a pixel that is not finite to one that is. Higher: larger holes become flat "
                          "spots; lower: more files are refused",
                          "not measured: a spot of that size shows", 1, 1024},
                     });

template <typename T>
struct Integers {
  static constexpr uint32_t one = std::numeric_limits<T>::max();
  static bool is_finite(T) { return true; }
  static bool is_zero(T v) { return v == 0; }
  static float number(T v) { return float(v) / float(one); }
  static T inverted(T v) { return T(one - v); }
  /// Undoes the multiplication of a colour by alpha, which is not 0.
  static T divided(T v, T alpha) { return T(std::min(one, (uint32_t{v} * one + alpha / 2u) / alpha)); }
};

struct Floats {
  static bool is_finite(float v) { return std::isfinite(v); }
  static bool is_zero(float v) { return v == 0; }
  static float number(float v) { return v; }
  static float inverted(float v) { return 1 - v; }
  static float divided(float v, float alpha) { return v / alpha; }
};

struct Halfs {
  static constexpr uint16_t exponent = 0x7c00, sign = 0x8000;
  static bool is_finite(uint16_t h) { return (h & exponent) != exponent; }
  static bool is_zero(uint16_t h) { return (h & ~sign) == 0; }
  static float number(uint16_t h) { return imath_half_to_float(h); }
  static uint16_t inverted(uint16_t h) { return imath_float_to_half(1 - number(h)); }
  static uint16_t divided(uint16_t h, uint16_t alpha) { return imath_float_to_half(number(h) / number(alpha)); }
};

}  // namespace

void StoredValues::note_hole(int64_t pixel, int channel) {
  holed_pixels_ += pixel != last_holed_;
  last_holed_ = pixel;
  const double most = std::max(1.0, stored_values_tuning->most_unfinite * double(meaning_.stored.area()));
  if (double(holed_pixels_) > most) return;  // they will be refused
  holes_.push_back({int(pixel % meaning_.stored.width), int(pixel / meaning_.stored.width), channel});
}

template <typename T, typename Traits>
void StoredValues::mend_as(std::span<T> values, const Traits& traits) {
  const int channels = meaning_.channels, colours = channels - (has_alpha() ? 1 : 0);
  const FormatFacts& facts = meaning_.facts;
  if (!has_alpha() && !facts.inverted_colours && !meaning_.is_float) {
    pixels_ += int64_t(values.size()) / channels;
    return;
  }
  for (T* p = values.data(); p != values.data() + values.size(); p += channels, pixels_++) {
    if (facts.inverted_colours)
      for (int c = 0; c < colours; c++) p[c] = traits.inverted(p[c]);
    if (has_alpha()) {
      T& alpha = p[colours];
      if (facts.inverted_alpha) alpha = traits.inverted(alpha);
      const bool is_zero = traits.is_zero(alpha);
      any_alpha_ |= !is_zero;
      if (meaning_.may_be_premultiplied) translucent_ += !is_zero && traits.number(alpha) < 1;
      if (facts.premultiplied || meaning_.may_be_premultiplied)
        brighter_ += std::any_of(p, p + colours, [&](T v) { return traits.number(v) > traits.number(alpha); });
      if (facts.premultiplied) {
        without_colour_ += is_zero;
        if (!is_zero)
          for (int c = 0; c < colours; c++) p[c] = traits.divided(p[c], alpha);
      }
    }
    if (!meaning_.is_float) continue;
    for (int c = 0; c < channels; c++) {
      if (!traits.is_finite(p[c])) note_hole(pixels_, c);
      if (meaning_.integer_range > 0)
        largest_[size_t(c)] = std::max(largest_[size_t(c)], std::abs(traits.number(p[c])));
    }
  }
}

void StoredValues::mend(std::span<uint8_t> values) {
  mend_as(values, Integers<uint8_t>());
}

void StoredValues::mend(std::span<uint16_t> values) {
  if (meaning_.is_float)
    mend_as(values, Halfs());
  else
    mend_as(values, Integers<uint16_t>());
}

void StoredValues::mend(std::span<float> values) {
  mend_as(values, Floats());
}

std::vector<StoredValues::Hole> StoredValues::filled_holes(const std::function<void(const Rect&, float*)>& read) const {
  const Rect all = whole(Size{meaning_.stored.width, meaning_.stored.height});
  std::vector<Hole> filled = holes_;
  std::vector<float> around;
  const auto fail = [&](const std::string& limit) {
    throw Error(
        fmt::format("{} of its {} are not finite (NaN or infinite), the first at ({}, {}); {}. Render it again, or "
                    "replace them, with OpenImageIO by \"oiiotool FILE --fixnan box3 -o FILE\"",
                    holed_pixels_, counted(all.area(), "pixel"), holes_.front().x + meaning_.stored.x,
                    holes_.front().y + meaning_.stored.y, limit));
  };
  if (double(holed_pixels_) > std::max(1.0, stored_values_tuning->most_unfinite * double(all.area())))
    fail(fmt::format("at most {:g} % are filled from their neighbours", stored_values_tuning->most_unfinite * 100));
  for (Hole& hole : filled) {
    int count = 0;
    for (int reach = 1; count == 0 && reach <= stored_values_tuning->largest_hole; reach *= 2) {
      const Rect square = intersect({hole.x - reach, hole.y - reach, 2 * reach + 1, 2 * reach + 1}, all);
      around.resize(size_t(square.area()) * size_t(meaning_.channels));
      read(square, around.data());
      double sum = 0;
      for (size_t i = size_t(hole.channel); i < around.size(); i += size_t(meaning_.channels)) {
        if (!std::isfinite(around[i]) || (count > 0 && !meaning_.can_be_averaged)) continue;
        sum += double(around[i]);
        count++;
      }
      if (count > 0) hole.value = float(sum / count);
    }
    if (count == 0)
      fail(fmt::format("no value within {} pixels of ({}, {}) is finite", stored_values_tuning->largest_hole,
                       hole.x + meaning_.stored.x, hole.y + meaning_.stored.y));
  }
  return filled;
}

std::vector<StoredValues::Remark> StoredValues::remarks() const {
  constexpr float least_of_shades = 1.0f / 256;  // distinguishable from 0 in 8 bits
  const auto are_ids = [&](float largest) { return largest > 0 && largest < least_of_shades; };
  if (const auto ids = std::ranges::find_if(largest_, are_ids); meaning_.integer_range > 0 && ids != largest_.end())
    throw Error(
        fmt::format("its values are 32-bit integers up to {:.0f} of {:.0f}: they seem to be ids or counts, and as "
                    "shades they would "
                    "all be nearly 0. Save them as 8- or 16-bit PNG, or as floats",
                    double(*ids) * meaning_.integer_range, meaning_.integer_range));
  std::vector<Remark> out;
  if (!meaning_.facts.note.empty()) out.push_back({meaning_.facts.note});
  if (meaning_.facts.inverted_colours) out.push_back({"it says that 0 is white; its values were inverted"});
  if (meaning_.facts.premultiplied) {
    std::string text = "it says that its colours are multiplied by alpha; they were divided by it";
    if (without_colour_ > 0)
      text += fmt::format(". {} of alpha 0 {} black", counted(without_colour_, "pixel"),
                          without_colour_ == 1 ? "stays" : "stay");
    if (brighter_ > 0)
      text += fmt::format(". Colours larger than alpha in {} say otherwise", counted(brighter_, "pixel"));
    out.push_back({text, without_colour_ > 0 || brighter_ > 0});
  }
  if (translucent_ > 0 && brighter_ == 0)
    out.push_back(
        {"no colour is larger than alpha, as in colours multiplied by it, which EXR files hold by convention; they are "
         "read as they are. If they are multiplied, divide them, with OpenImageIO by \"oiiotool FILE --unpremult -o "
         "FILE\""});
  if (is_invisible())
    out.push_back({"its alpha is 0 everywhere, so that nothing would be seen; it is read as opaque", true});
  if (!holes_.empty())
    out.push_back({fmt::format("{} {} not finite (NaN or infinite), the first at ({}, {}); replaced by {}",
                               counted(holed_pixels_, "pixel"), holed_pixels_ == 1 ? "is" : "are",
                               holes_.front().x + meaning_.stored.x, holes_.front().y + meaning_.stored.y,
                               meaning_.can_be_averaged ? "the mean of their neighbours" : "neighbours"),
                   true});
  return out;
}

}  // namespace terrazzo
