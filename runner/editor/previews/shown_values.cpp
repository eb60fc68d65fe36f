#include "runner/editor/previews/shown_values.h"

#include <algorithm>
#include <cmath>

#include "core/exemplar/appearance.h"
#include "core/exemplar/features.h"
#include "core/exemplar/uv_image.h"
#include "runner/report/pictures.h"

namespace terrazzo {

namespace {

std::string semantic_of(const Image& image) {
  return std::string(name_of(image.info().semantic));
}

void add_material(const Material& material, std::vector<ShownImage>& out) {
  for (const Map& m : material.maps()) out.push_back({m.name, m.image, semantic_of(*m.image), m.image->size()});
  const auto main = std::ranges::find(out, "base_color", &ShownImage::semantic);
  if (main != out.end()) std::rotate(out.begin(), main, main + 1);
}

/// Elements in colours that tell neighbours apart.
ImagePtr elements_in_colours(const Elements& elements) {
  std::vector<float> out;
  out.reserve(elements.at.size() * 3);
  for (const uint16_t element : elements.at) {
    const uint64_t bits = random_bits(element);
    for (int c = 0; c < 3; c++) out.push_back(0.15f + 0.8f * float((bits >> (16 * c)) & 0xffff) / 65535.0f);
  }
  return Image::from_floats({.size = elements.size, .channels = 3}, std::move(out));
}

void add_features(const Features& features, std::vector<ShownImage>& out) {
  if (features.elements())
    out.push_back({"elements", elements_in_colours(*features.elements()), "data", features.size(), false});
  for (const FeatureImage& f : features.images())
    out.push_back({f.map, f.image, semantic_of(*f.image), f.image->size(), false});
}

/// The first three components of the finest level, each stretched to the whole range.
ImagePtr components_of(const Appearance& appearance) {
  constexpr int shown = 3;
  const AppearanceLevel& level = appearance.levels().front();
  std::array<int16_t, shown> least{}, most{};
  for (const AppearanceVector& v : level.vectors)
    for (size_t c = 0; c < shown; c++) {
      least[c] = std::min(least[c], v[c]);
      most[c] = std::max(most[c], v[c]);
    }
  std::vector<float> out;
  out.reserve(level.vectors.size() * shown);
  for (const AppearanceVector& v : level.vectors)
    for (size_t c = 0; c < shown; c++) out.push_back(float(v[c] - least[c]) / float(std::max(1, most[c] - least[c])));
  return Image::from_floats({.size = level.size, .channels = shown}, std::move(out));
}

}  // namespace

std::vector<ShownImage> shown_images(const Value& value, int longest) {
  std::vector<ShownImage> out;
  switch (type_of(value)) {
    case ValueType::image: {
      const ImagePtr& image = std::get<ImagePtr>(value);
      out.push_back({"", image, semantic_of(*image), image->size()});
      break;
    }
    case ValueType::material:
      add_material(*std::get<MaterialPtr>(value), out);
      break;
    case ValueType::features:
      add_features(*std::get<FeaturesPtr>(value), out);
      break;
    case ValueType::appearance: {
      const Appearance& appearance = *std::get<AppearancePtr>(value);
      out.push_back({"", components_of(appearance), "data", appearance.size(), false});
      break;
    }
    case ValueType::index: {
      const AppearancePtr& appearance = std::get<IndexPtr>(value)->appearance();
      out.push_back({"", components_of(*appearance), "data", appearance->size(), false});
      break;
    }
    case ValueType::uv_map: {
      const UvMapPtr& uv = std::get<UvMapPtr>(value);
      out.push_back({"", uv_in_colours(*uv, longest), "uv", uv->size(), false, uv_as_fractions(uv), uv->exemplar()});
      break;
    }
    case ValueType::report:
      for (const Report::Picture& p : std::get<ReportPtr>(value)->pictures())
        out.push_back({p.name, p.image, semantic_of(*p.image), p.image->size()});
      break;
  }
  return out;
}

ImagePtr resolved_coarsely(const UvMap& coarse, const Image& exemplar) {
  const double across = double(exemplar.width()) / coarse.exemplar().width;
  const double down = double(exemplar.height()) / coarse.exemplar().height;
  constexpr double rounding = 0.02;
  if (std::abs(across - down) > rounding * across) return nullptr;
  const std::vector<float> pixels = exemplar.pixels();
  const auto channels = size_t(exemplar.channels());
  const auto at = [](int position, double scale, int side) {
    return size_t(std::clamp(int((position + 0.5) * scale), 0, side - 1));
  };
  std::vector<float> out;
  out.reserve(coarse.pixels().size() * channels);
  for (const ExemplarPixel& p : coarse.pixels()) {
    const size_t x = at(p.x, across, exemplar.width()), y = at(p.y, down, exemplar.height());
    const auto pixel = pixels.begin() + ptrdiff_t((y * size_t(exemplar.width()) + x) * channels);
    out.insert(out.end(), pixel, pixel + ptrdiff_t(channels));
  }
  ImageInfo info = exemplar.info();
  info.size = coarse.size();
  return Image::from_floats(info, std::move(out));
}

}  // namespace terrazzo
