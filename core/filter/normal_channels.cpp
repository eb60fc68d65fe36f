#include "core/filter/normal_channels.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/tuning.h"
#include "core/filter/normal_convention.h"
#include "core/image_io/file_pixels.h"
#include "core/numeric/moments.h"

namespace terrazzo {

namespace {

struct NormalChannelsTuning {
  double noise = 8.0 / 255;
  double rare = 0.005;
  double constant = 0.05;
  double near = 0.06;
  double misfit = 0.03;
  double follows = 0.3;
  double clear = 0.3;
  double lead = 1.5;
  double overlong = 0.2;
};
const Tunable<NormalChannelsTuning> normal_channels_tuning(
    "normal_channels",
    {
        {&NormalChannelsTuning::noise, "noise", "of the range of values",
         "by which channels that are the same may differ. Higher: coloured maps are taken for grey; lower: lossy grey "
         "ones are not",
         "not measured: as material_maps.compression_noise", 0, 1},
        {&NormalChannelsTuning::rare, "rare", "of the pixels", "that may differ by more. Higher, lower: likewise",
         "not measured: single pixels are damage", 0, 1},
        {&NormalChannelsTuning::constant, "constant", "of the range of values",
         "standard deviation of an empty blue channel. Higher: flat normals lose their z; lower: what JPEG makes of an "
         "empty channel is not known",
         "normal_channels", 0, 1},
        {&NormalChannelsTuning::near, "near", "of the range of values",
         "from an empty blue channel's mean to 0, 1/2 or 1. Higher, lower: likewise", "normal_channels", 0, 0.25},
        {&NormalChannelsTuning::misfit, "misfit", "of the range of values",
         "of a full blue channel to the z of x and y, root mean square. Higher: full channels are kept; lower: z of "
         "gentle normals is made anew",
         "normal_channels", 0, 1},
        {&NormalChannelsTuning::follows, "follows", "correlation",
         "of blue with the z of x and y, beyond which it is no empty channel. Higher: lossy z is made anew; lower: "
         "full channels are kept",
         "not measured: far from what either kind has", 0, 1},
        {&NormalChannelsTuning::clear, "clear", "correlation",
         "of x and y with the slopes of a surface. Higher: more files are refused; lower: noise decides",
         "normal_channels", 0, 1},
        {&NormalChannelsTuning::lead, "lead", "times",
         "by which one reading of two channels must be better than the other. Higher: more files are refused; lower: x "
         "and y are swapped",
         "normal_channels", 1, 10},
        {&NormalChannelsTuning::overlong, "overlong", "of the pixels",
         "that may have x and y longer than 1. Higher: what is no normal map is read as one; lower: noisy ones are "
         "refused",
         "not measured: far from what either kind has", 0, 1},
    });

/// The encoded z of a unit normal, from its encoded x and y.
float encoded_z(float x, float y) {
  const float u = x * 2 - 1, v = y * 2 - 1;
  return std::sqrt(std::max(0.0f, 1 - u * u - v * v)) * 0.5f + 0.5f;
}

/// Statistics of the pixels' channels.
class ChannelLook {
 public:
  explicit ChannelLook(const Image& image) : image_(image), channels_(image.channels()), moments_(channels_ + 1) {
    for_each_strip(image, [&](const Rect& r, const float* p) {
      std::array<float, 5> values{};
      for (int64_t i = 0; i < r.area(); i++, p += channels_) {
        std::copy_n(p, channels_, values.begin());
        values[size_t(channels_)] = channels_ >= 3 ? encoded_z(p[0], p[1]) : 0;
        moments_.add(values.data());
        if (channels_ >= 3) misfit_ += (double(p[2]) - values[size_t(channels_)]) * (p[2] - values[size_t(channels_)]);
        for (int a = 0; a < channels_; a++)
          for (int b = 0; b < a; b++)
            differ_[size_t(a)][size_t(b)] += std::abs(p[a] - p[b]) > float(normal_channels_tuning->noise);
      }
    });
  }
  double mean(int c) const { return moments_.mean(c); }
  double deviation(int c) const { return std::sqrt(moments_.variance(c)); }
  bool same(int a, int b) const {
    return double(differ_[size_t(std::max(a, b))][size_t(std::min(a, b))]) <=
           normal_channels_tuning->rare * double(image_.size().area());
  }
  bool is_constant(int c) const { return deviation(c) <= normal_channels_tuning->constant; }
  /// Constant, with a value that is common for unused channels.
  bool is_empty(int c) const { return is_constant(c) && (is_near(c, 0) || is_near(c, 0.5) || is_near(c, 1)); }
  bool is_near(int c, double value) const { return std::abs(mean(c) - value) <= normal_channels_tuning->near; }
  bool is_opaque() const { return deviation(channels_ - 1) < 1e-6; }
  /// The root mean square difference of blue and the z of red and green.
  double misfit() const { return std::sqrt(misfit_ / double(image_.size().area())); }
  /// The correlation of blue with the z of red and green.
  double follows() const {
    const double product = deviation(2) * deviation(channels_);
    return product > 1e-9 ? moments_.covariance(2, channels_) / product : 0;
  }

 private:
  const Image& image_;
  const int channels_;
  Moments<> moments_;
  double misfit_ = 0;
  std::array<std::array<int64_t, 4>, 4> differ_{};
};

/// How well two channels are x and y of a surface.
double evidence(const Image& xy, const Image* height) {
  if (!height) return std::abs(convention_from_curl(xy).along_y);
  const ConventionEvidence e = convention_from_height(xy, *height);
  return std::max(std::abs(e.along_x), std::abs(e.along_y));
}

/// Whether the second of two channels is x, and the first y; nullopt if the pixels are inconclusive.
std::optional<bool> are_swapped(const ImagePtr& image, int first, int second, const Image* height) {
  const auto two = [&](int x, int y) { return chosen_channels(image, image->info(), {x, y}, false); };
  for (const Image* by : {height, static_cast<const Image*>(nullptr)}) {
    const double straight = evidence(*two(first, second), by), swapped = evidence(*two(second, first), by);
    const double best = std::max(straight, swapped), other = std::min(straight, swapped);
    if (best >= normal_channels_tuning->clear && best >= normal_channels_tuning->lead * other)
      return swapped > straight;
    if (!by) break;
  }
  return std::nullopt;
}

/// The part of a channel's name after its layer's, in lower case.
std::string bare(const std::string& name) {
  return lowercase(name.substr(name.rfind('.') == name.npos ? 0 : name.rfind('.') + 1));
}

/// The first channel that has one of the names; -1 if none has.
int find_channel(const std::vector<std::string>& names, std::initializer_list<std::string_view> wanted) {
  const auto at = std::ranges::find_if(
      names, [&](const std::string& n) { return std::ranges::find(wanted, bare(n)) != wanted.end(); });
  return at == names.end() ? -1 : int(at - names.begin());
}

[[noreturn]] void fail_grey() {
  throw Error(
      "it is grey, and so no normal map: normals need x and y. If it is a height or bump map, call it height; "
      "make_normal "
      "makes normals of it");
}

/// Grey and alpha, in two channels or in four.
NormalLayout layout_of_grey_and_alpha(const ImagePtr& image, int grey, int alpha, const Image* height,
                                      const std::string& advice) {
  const std::optional<bool> swapped = are_swapped(image, grey, alpha, height);
  if (!swapped)
    throw Error(fmt::format(
        "it holds grey and alpha, which may be x and y, or y and x as in DXT5nm, and its pixels do not say which. Say "
        "it by {} (x is grey) or \"dxt5nm\" (x is alpha)",
        advice));
  return {.x = *swapped ? alpha : grey,
          .y = *swapped ? grey : alpha,
          .has_z = false,
          .reason = *swapped ? "it holds y in grey and x in alpha, as DXT5nm, told by its pixels"
                             : "it holds x in grey and y in alpha, told by its pixels"};
}

NormalLayout layout_of_two(const ImagePtr& image, const std::vector<std::string>& names, const Image* height,
                           const std::string& advice) {
  const int x = find_channel(names, {"x", "r", "nx", "red"}), y = find_channel(names, {"y", "g", "ny", "green"});
  const int alpha = find_channel(names, {"a", "alpha"});
  if (x >= 0 && y >= 0 && alpha < 0) return {.x = x, .y = y, .has_z = false, .reason = "it has no z"};
  if (alpha >= 0 && y >= 0 && bare(names[size_t(y)]) != "y")
    return {.x = alpha, .y = y, .has_z = false, .reason = "it holds x in alpha and y in green, as DXT5nm"};
  const ChannelLook look(*image);
  if (look.is_opaque() || look.same(0, 1)) fail_grey();
  return layout_of_grey_and_alpha(image, 0, 1, height, advice);
}

NormalLayout layout_of_many(const ImagePtr& image, const Image* height, const std::string& advice) {
  const ChannelLook look(*image);
  const bool has_alpha = image->channels() == 4 && !look.is_opaque();
  const bool copies = look.same(0, 1) && look.same(1, 2);
  if (copies && !has_alpha) fail_grey();
  if (copies) return layout_of_grey_and_alpha(image, 1, 3, height, advice);
  const bool blue_is_copy = look.same(1, 2) || look.same(0, 2);
  if (has_alpha && (look.is_empty(0) || look.same(0, 1)) && (look.is_constant(2) || blue_is_copy))
    return {.x = 3, .y = 1, .has_z = false, .reason = "it holds x in alpha and y in green, as DXT5nm"};
  const auto without_z = [](std::string reason) { return NormalLayout{.has_z = false, .reason = std::move(reason)}; };
  if (blue_is_copy) return without_z(fmt::format("its blue is a copy of its {}", look.same(1, 2) ? "green" : "red"));
  // A constant channel may still be a z: signed normals without z are encoded as one half, flat normals as 1. A blue
  // that falls with z belongs to normals that point into the surface.
  if (look.misfit() <= normal_channels_tuning->misfit || std::abs(look.follows()) > normal_channels_tuning->follows)
    return {};
  if (!look.is_empty(2))
    return {.doubt = fmt::format("its blue is not the z of red and green (correlation {:.2f}, off by {:.2f})",
                                 look.follows(), look.misfit())};
  return without_z(fmt::format("its blue is {} throughout", look.is_near(2, 0)   ? "0"
                                                            : look.is_near(2, 1) ? "full"
                                                                                 : "one half"));
}

NormalLayout layout_given(const Image& image, const std::vector<std::string>& names, NormalChannels given) {
  const int channels = image.channels();
  require_channels(given, channels);
  switch (given) {
    case NormalChannels::xyz:
      return {.is_given = true};
    case NormalChannels::xy: {
      const int x = find_channel(names, {"x", "nx"}), y = find_channel(names, {"y", "ny"});
      const bool named = channels == 2 && x >= 0 && y >= 0;
      return {.x = named ? x : 0,
              .y = named ? y : 1,
              .has_z = false,
              .reason = "it is said to have no z",
              .is_given = true};
    }
    case NormalChannels::dxt5nm:
      break;
  }
  return {.x = channels - 1,
          .y = channels == 2 ? 0 : 1,
          .has_z = false,
          .reason = "it is said to hold x in alpha and y in green, as DXT5nm",
          .is_given = true};
}

double overlong_share(const Image& image, const NormalLayout& layout) {
  constexpr float clearly = 1.1f * 1.1f;
  int64_t count = 0;
  for_each_strip(image, [&](const Rect& r, const float* p) {
    for (int64_t i = 0; i < r.area(); i++, p += image.channels()) {
      const float u = p[layout.x] * 2 - 1, v = p[layout.y] * 2 - 1;
      count += u * u + v * v > clearly;
    }
  });
  return double(count) / double(image.size().area());
}

class RebuiltNormals : public PixelSource {
 public:
  RebuiltNormals(ImagePtr image, int x, int y) : image_(std::move(image)), x_(x), y_(y) {}
  void read(const Rect& region, float* out) const override {
    const int channels = image_->channels();
    for (int y = region.y; y < region.bottom(); y++) {
      const std::vector<float> row = image_->read({region.x, y, region.width, 1});
      for (const float* p = row.data(); p != row.data() + row.size(); p += channels) {
        *out++ = p[x_];
        *out++ = p[y_];
        *out++ = encoded_z(p[x_], p[y_]);
      }
    }
  }

 private:
  const ImagePtr image_;
  const int x_, y_;
};

}  // namespace

void require_channels(NormalChannels given, int channels) {
  const auto require = [&](bool fits, std::string_view needed) {
    if (!fits)
      throw Error(fmt::format("it has {}, and \"{}\" needs {}", counted(channels, "channel"),
                              normal_channels_names[size_t(given)], needed));
  };
  switch (given) {
    case NormalChannels::xyz:
      return require(channels >= 3, "three");
    case NormalChannels::xy:
      return require(channels >= 2, "two");
    case NormalChannels::dxt5nm:
      return require(channels == 2 || channels == 4, "alpha");
  }
}

NormalLayout normal_layout(const ImagePtr& image, const std::vector<std::string>& names, const Image* height,
                           std::optional<NormalChannels> given, const std::string& advice) {
  if (image->channels() == 1) fail_grey();
  NormalLayout out = given                    ? layout_given(*image, names, *given)
                     : image->channels() == 2 ? layout_of_two(image, names, height, advice)
                                              : layout_of_many(image, height, advice);
  if (out.has_z) return out;
  out.overlong = overlong_share(*image, out);
  if (!out.is_given && out.overlong > normal_channels_tuning->overlong)
    throw Error(
        fmt::format("{}, but in {:.0f} % of the pixels x and y are longer than a normal: it is not a normal map, or x "
                    "was in a channel that is lost. Say what it is by {}, or leave it out",
                    out.reason, 100 * out.overlong, advice));
  return out;
}

ImagePtr with_z_rebuilt(const ImagePtr& image, const NormalLayout& layout) {
  ImageInfo info = image->info();
  info.channels = 3;
  return held_or_read(info, std::make_shared<RebuiltNormals>(image, layout.x, layout.y));
}

}  // namespace terrazzo
