#include "core/naming/packing_guess.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/base/hash.h"
#include "core/base/tuning.h"
#include "core/filter/resample.h"

namespace terrazzo {

namespace {

struct PackingGuessTuning {
  double metal_share = 0.95;
  double metal_tolerance = 0.06;
  double least_white = 0.95;
  double least_mean_lead = 0.05;
  double least_hollow_lead = 0.05;
  double least_hollow = 0.25;
  double least_skew = 0.5;
};
constexpr const char* measured = "packings without a name";
const Tunable<PackingGuessTuning> packing_guess_tuning(
    "packing_guess",
    {
        {&PackingGuessTuning::metal_share, "metal_share", "of the pixels",
         "that must be black or white in a metallic map. Higher: fewer packings are found; lower: contrasty roughness "
         "is taken for metal",
         measured, 0.5, 1},
        {&PackingGuessTuning::metal_tolerance, "metal_tolerance", "of the range of values",
         "that black and white may be off. Higher: dark roughness is taken for metal; lower: lossy files are not found",
         measured, 0, 0.4},
        {&PackingGuessTuning::least_white, "least_white", "of the range of values",
         "that the brightest occlusion has. Higher: fewer packings are found; lower: roughness is taken for occlusion",
         measured, 0, 1},
        {&PackingGuessTuning::least_mean_lead, "least_mean_lead", "of the range of values",
         "by which occlusion must be brighter than roughness on average. Higher: fewer are found; lower: more wrongly",
         measured, 0, 1},
        {&PackingGuessTuning::least_hollow_lead, "least_hollow_lead", "correlation",
         "by which occlusion must follow the hollows better than roughness. Higher: fewer are found; lower: more "
         "wrongly",
         measured, 0, 2},
        {&PackingGuessTuning::least_hollow, "least_hollow", "correlation",
         "of occlusion with the height above its surroundings. Higher: fewer are found; lower: more wrongly", measured,
         -1, 1},
        {&PackingGuessTuning::least_skew, "least_skew", "skewness",
         "towards white of occlusion without a height map. Higher: fewer are found; lower: more wrongly", measured, 0,
         100},
    });

/// One channel, or how far the height lies above its surroundings.
using Plane = std::vector<float>;

constexpr int side = 256;

ImagePtr small(const ImagePtr& image, Size size) {
  return resampled(image, size, "box", Outside::wrap, Hasher().add("guess").digest());
}

std::vector<Plane> planes_of(const Image& image) {
  const std::vector<float> pixels = image.pixels();
  std::vector<Plane> planes(size_t(image.channels()), Plane(size_t(image.size().area())));
  for (size_t i = 0; i < pixels.size(); i++)
    planes[i % size_t(image.channels())][i / size_t(image.channels())] = pixels[i];
  return planes;
}

double mean(const Plane& p) {
  double sum = 0;
  for (const float v : p) sum += v;
  return sum / double(p.size());
}

double covariance(const Plane& a, const Plane& b) {
  const double mean_a = mean(a), mean_b = mean(b);
  double sum = 0;
  for (size_t i = 0; i < a.size(); i++) sum += (a[i] - mean_a) * (b[i] - mean_b);
  return sum / double(a.size());
}

double correlation(const Plane& a, const Plane& b) {
  const double variances = covariance(a, a) * covariance(b, b);
  return variances > 1e-16 ? covariance(a, b) / std::sqrt(variances) : 0;
}

/// 0 for a plane of one value.
double skewness(const Plane& p) {
  const double centre = mean(p), variance = covariance(p, p);
  double sum = 0;
  for (const float v : p) sum += (v - centre) * (v - centre) * (v - centre);
  return variance > 1e-8 ? sum / double(p.size()) / (variance * std::sqrt(variance)) : 0;
}

bool is_metal(const Plane& p) {
  const auto tolerance = float(packing_guess_tuning->metal_tolerance);
  const auto extreme = std::count_if(p.begin(), p.end(), [&](float v) { return v <= tolerance || v >= 1 - tolerance; });
  return double(extreme) >= packing_guess_tuning->metal_share * double(p.size());
}

/// How far the height lies above its surroundings.
Plane above_surroundings(const ImagePtr& height, Size size) {
  constexpr double reach = 4;  // pixels, of at most 256
  const ImagePtr low = small(height, size);
  const ImagePtr around = filtered(low, low->info(), Hasher().add("around").digest(), gaussian_filter(reach),
                                   gaussian_filter(reach), Outside::wrap);
  Plane out = planes_of(*low).front();
  const Plane smooth = planes_of(*around).front();
  for (size_t i = 0; i < out.size(); i++) out[i] -= smooth[i];
  return out;
}

/// Statistics of a channel.
struct Channel {
  Plane plane;
  double mean = 0, brightest = 0;
  double hollow = 0;  ///< correlation with the height above its surroundings
  bool is_metal = false;
};

/// A packing by the contents of its channels; '-' is a constant.
struct Packing {
  std::string_view name;
  std::string_view order;  ///< o, r, m, s for smoothness
};
constexpr std::array layouts = {Packing{"ORM", "orm"}, Packing{"RMA", "rmo"}, Packing{"MRA", "mro"},
                                Packing{"MaskMap", "mo-s"}};

bool fits_occlusion(const Channel& occlusion, const Channel& roughness, bool have_height) {
  const bool leads = occlusion.mean >= roughness.mean + packing_guess_tuning->least_mean_lead;
  if (!leads || occlusion.brightest < packing_guess_tuning->least_white || occlusion.is_metal) return false;
  if (have_height)
    return occlusion.hollow >= packing_guess_tuning->least_hollow &&
           occlusion.hollow >= roughness.hollow + packing_guess_tuning->least_hollow_lead;
  return -skewness(occlusion.plane) >= packing_guess_tuning->least_skew;
}

bool fits(const Packing& layout, std::vector<Channel> channels, bool have_height) {
  if (layout.order.size() != channels.size()) return false;
  const Channel *occlusion = nullptr, *roughness = nullptr;
  for (size_t i = 0; i < channels.size(); i++) {
    Channel& c = channels[i];
    const char what = layout.order[i];
    if (what == 'm' && !c.is_metal) return false;
    if (what == '-' && skewness(c.plane) != 0) return false;
    if (what == 'o') occlusion = &c;
    if (what == 's') {
      c.mean = 1 - c.mean;
      c.hollow = -c.hollow;
    }
    if (what == 'r' || what == 's') roughness = &c;
  }
  return !roughness->is_metal && fits_occlusion(*occlusion, *roughness, have_height);
}

PackingGuess guess_of(const Packing& layout, bool have_height) {
  PackingGuess out;
  for (size_t i = 0; i < layout.order.size(); i++) {
    const char what = layout.order[i], channel = "rgba"[i];
    if (what == 'o') out.maps.push_back({Semantic::ambient_occlusion, channel});
    if (what == 'm') out.maps.push_back({Semantic::metallic, channel});
    if (what == 'r' || what == 's') out.maps.push_back({Semantic::roughness, channel, what == 's'});
  }
  out.grounds = fmt::format("{} by its pixels: one channel is black or white, one is bright but {}", layout.name,
                            have_height ? "in hollows of the height" : "for few dark places");
  return out;
}

}  // namespace

double hollow_correlation(const ImagePtr& occlusion, const ImagePtr& height) {
  const Size size{std::min(side, occlusion->width()), std::min(side, occlusion->height())};
  return correlation(planes_of(*small(occlusion, size)).front(), above_surroundings(height, size));
}

PackingGuess guess_packing(const ImagePtr& file, const ImagePtr& height) {
  const Size size{std::min(side, file->width()), std::min(side, file->height())};
  const std::vector<Plane> planes = planes_of(*small(file, size));
  Plane hollow;
  if (height) hollow = above_surroundings(height, size);
  std::vector<Channel> channels;
  for (const Plane& p : planes)
    channels.push_back({.plane = p,
                        .mean = mean(p),
                        .brightest = *std::max_element(p.begin(), p.end()),
                        .hollow = height ? correlation(p, hollow) : 0,
                        .is_metal = is_metal(p)});
  const Packing* found = nullptr;
  for (const Packing& layout : layouts) {
    if (!fits(layout, channels, height != nullptr)) continue;
    if (found) return {};  // it could be either
    found = &layout;
  }
  return found ? guess_of(*found, height != nullptr) : PackingGuess();
}

}  // namespace terrazzo
