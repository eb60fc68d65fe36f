#include "tests/sample_values.h"

#include <bit>

#include "core/exemplar/appearance.h"
#include "core/exemplar/features.h"
#include "core/exemplar/repeats.h"
#include "core/exemplar/uv_map.h"
#include "core/material/material.h"

namespace terrazzo::test {

namespace {

ImagePtr float_image(Size size) {
  ImageInfo info{.size = size, .channels = 1, .semantic = Semantic::height};
  std::vector<float> pixels;
  for (int64_t i = 0; i < size.area(); i++) pixels.push_back(float(i) / 7.0f - 1.0f);
  return Image::from_floats(info, std::move(pixels));
}

FingerprintPtr sample_fingerprint() {
  const std::vector<uint8_t> rising = {0, 51, 102, 153, 204, 255};
  return std::make_shared<Fingerprint>(Fingerprint{{3, 2}, {{"height", 0, rising}, {"normal", 1, rising}}});
}

ElementsPtr sample_elements(Size size) {
  Elements e{size, {}, 3, 0.75};
  for (int64_t i = 0; i < size.area(); i++) e.at.push_back(uint16_t(i % 3));
  return std::make_shared<const Elements>(std::move(e));
}

AppearancePtr sample_appearance() {
  std::vector<AppearanceLevel> levels(2);
  for (size_t i = 0; i < levels.size(); i++) {
    AppearanceLevel& l = levels[i];
    l.size = {16 >> i, 12 >> i};
    for (int64_t p = 0; p < l.size.area(); p++)
      for (auto& v = l.vectors.emplace_back(); auto& c : v) c = int16_t(p * 7 - 100);
    if (i == 0) l.usable.assign(l.vectors.size(), 1), l.usable.back() = 0;
    l.dimensions = 3;
    l.mean.assign(25 * 2, 0.25f);
    l.basis.assign(3 * 25 * 2, -0.5f);
    l.scale = 0.1;
    l.retained = 0.97;
  }
  const Lattice tiles{2, {4, 0.5}, {0, 3}, 0.5}, courses{1, {0, 2}, {}, 0.25};
  const Repeats repeats({{{0, 0, 4, 6}, tiles, tiles, {}}, {{4, 0, 4, 6}, courses, courses, {0.5, 1.25}}});
  return Appearance::make(std::move(levels), 2, true, repeats, sample_fingerprint(), sample_elements({16, 12}));
}

/// Of an exemplar of streaks.
AppearancePtr shortened_appearance() {
  AppearanceLevel l;
  l.size = {16, 20};
  l.vectors.resize(320);
  l.dimensions = 1;
  l.mean.assign(25, 0.5f);
  l.basis.assign(25, 0.25f);
  Repeats repeats(Lattice{1, {0, 2}, {}, 0.25});
  repeats.streaks.x = 4;
  return Appearance::make({l}, 1, false, repeats, nullptr, nullptr, {67, 20});
}

IndexPtr sample_index() {
  AppearancePtr appearance = sample_appearance();
  std::vector<SimilarSets> levels;
  for (const AppearanceLevel& l : appearance->levels()) {
    SimilarSets s;
    s.per_pixel = 2;
    for (int64_t i = 0; i < 2 * l.size.area(); i++) s.positions.push_back(uint32_t(i / 2));
    levels.push_back(std::move(s));
  }
  return Index::make(std::move(appearance), std::move(levels));
}

UvMapPtr sample_uv_map() {
  std::vector<ExemplarPixel> pixels;
  for (int i = 0; i < 5 * 4; i++) pixels.push_back({uint16_t(i % 8), uint16_t(i % 6)});
  return UvMap::make({5, 4}, {8, 6}, std::move(pixels), {.x = true, .exemplar = true}, sample_fingerprint());
}

struct SameContent {
  bool operator()(const ImagePtr& a, const ImagePtr& b) const {
    if (a->info() != b->info() || a->digest() != b->digest()) return false;
    const std::vector<float> p = a->pixels(), q = b->pixels();
    for (size_t i = 0; i < p.size(); i++)
      if (std::bit_cast<uint32_t>(p[i]) != std::bit_cast<uint32_t>(q[i])) return false;
    return p.size() == q.size();
  }
  bool operator()(const MaterialPtr& a, const MaterialPtr& b) const {
    bool same = a->name() == b->name() && a->maps().size() == b->maps().size();
    for (size_t i = 0; same && i < a->maps().size(); i++)
      same = a->maps()[i].name == b->maps()[i].name && (*this)(a->maps()[i].image, b->maps()[i].image);
    return same;
  }
  bool operator()(const FeaturesPtr& a, const FeaturesPtr& b) const {
    bool same = a->size() == b->size() && a->wraps() == b->wraps() && a->images().size() == b->images().size() &&
                a->repeats() == b->repeats() && (*this)(a->mask(), b->mask());
    for (size_t i = 0; same && i < a->images().size(); i++)
      same = a->images()[i].map == b->images()[i].map && a->images()[i].weights == b->images()[i].weights &&
             (*this)(a->images()[i].image, b->images()[i].image);
    return same;
  }
  bool operator()(const FingerprintPtr& a, const FingerprintPtr& b) const {
    if (!a || !b) return a == b;
    bool same = a->cells == b->cells && a->channels.size() == b->channels.size();
    for (size_t i = 0; same && i < a->channels.size(); i++) {
      const Fingerprint::Channel &c = a->channels[i], &d = b->channels[i];
      same = c.map == d.map && c.channel == d.channel && c.means == d.means;
    }
    return same;
  }
  bool operator()(const AppearancePtr& a, const AppearancePtr& b) const {
    bool same = a->size() == b->size() && a->wraps() == b->wraps() && a->channels() == b->channels() &&
                a->repeats() == b->repeats() && a->levels().size() == b->levels().size() &&
                (*this)(a->fingerprint(), b->fingerprint());
    for (size_t i = 0; same && i < a->levels().size(); i++) {
      const AppearanceLevel &l = a->levels()[i], &m = b->levels()[i];
      same = l.size == m.size && l.vectors == m.vectors && l.usable == m.usable && l.dimensions == m.dimensions &&
             l.mean == m.mean && l.basis == m.basis && l.scale == m.scale && l.retained == m.retained;
    }
    return same;
  }
  bool operator()(const IndexPtr& a, const IndexPtr& b) const {
    bool same = (*this)(a->appearance(), b->appearance()) && a->levels().size() == b->levels().size();
    for (size_t i = 0; same && i < a->levels().size(); i++)
      same =
          a->levels()[i].per_pixel == b->levels()[i].per_pixel && a->levels()[i].positions == b->levels()[i].positions;
    return same;
  }
  bool operator()(const UvMapPtr& a, const UvMapPtr& b) const {
    return a->size() == b->size() && a->exemplar() == b->exemplar() && a->wraps() == b->wraps() &&
           a->pixels() == b->pixels() && (*this)(a->fingerprint(), b->fingerprint());
  }
  bool operator()(const ReportPtr& a, const ReportPtr& b) const {
    bool same = a->title() == b->title() && a->figures().size() == b->figures().size() &&
                a->pictures().size() == b->pictures().size();
    for (size_t i = 0; same && i < a->figures().size(); i++) {
      const Report::Figure &f = a->figures()[i], &g = b->figures()[i];
      same = f.name == g.name && f.value == g.value && f.help == g.help;
    }
    for (size_t i = 0; same && i < a->pictures().size(); i++)
      same = a->pictures()[i].name == b->pictures()[i].name && (*this)(a->pictures()[i].image, b->pictures()[i].image);
    return same;
  }
};

}  // namespace

ImagePtr sample_image(Size size, int seed) {
  ImageInfo info{
      .size = size, .channels = 3, .semantic = Semantic::base_color, .color_space = "srgb_texture", .depth = Depth::u8};
  std::vector<float> pixels;
  for (int64_t i = 0; i < size.area() * 3; i++)
    pixels.push_back(float(random_bits(uint64_t(seed), uint64_t(i)) >> 56) / 255.0f);
  return Image::from_floats(info, std::move(pixels));
}

std::vector<Value> sample_values() {
  const ImagePtr color = sample_image({7, 5}), height = float_image({7, 5});
  std::vector<Report::Figure> figures = {{"distance", 0.25, "lower is better"}, {"kind", std::string("brick"), ""}};
  return {color,
          Material::make("wall", {{"base_color", color}, {"height", height}}),
          Features::make({7, 5}, {{color, {1, 0.5, 0}, "base_color"}, {height, {2}}}, true, {}, height,
                         sample_elements({7, 5})),
          sample_appearance(),
          sample_index(),
          sample_uv_map(),
          Report::make("quality", std::move(figures), {{"side by side", color}}),
          shortened_appearance()};
}

bool same_content(const Value& a, const Value& b) {
  if (type_of(a) != type_of(b) || digest_of(a) != digest_of(b)) return false;
  return std::visit([&b]<typename T>(const T& content) { return SameContent()(content, std::get<T>(b)); }, a);
}

}  // namespace terrazzo::test
