#include "tests/golden/content.h"

#include <algorithm>
#include <cmath>

#include <OpenImageIO/color.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "core/exemplar/appearance.h"
#include "core/exemplar/features.h"
#include "core/exemplar/uv_map.h"
#include "core/image_io/image_file.h"
#include "core/material/material.h"
#include "core/node/serialize.h"
#include "tests/odd_images.h"

namespace terrazzo::test {

namespace {

constexpr size_t sample_count = 4;

/// Feeds values into a digest, and all of their numbers into the figures.
class Reader {
 public:
  Content content() const {
    Content out;
    out.digest = hasher_.digest();
    const double n = double(std::max<size_t>(1, numbers_.size()));
    for (const double v : numbers_) out.mean += v / n;
    for (const double v : numbers_) out.deviation += (v - out.mean) * (v - out.mean) / n;
    out.deviation = std::sqrt(out.deviation);
    for (size_t i = 0; i < sample_count && !numbers_.empty(); i++)
      out.samples.push_back(numbers_[(2 * i + 1) * numbers_.size() / (2 * sample_count)]);
    return out;
  }

  void operator()(const ImagePtr& image) {
    const std::vector<float> pixels = image->pixels();
    add(*image);
    numbers(pixels);
  }
  void operator()(const MaterialPtr& material) {
    hasher_.add(material->name()).add(int64_t(material->maps().size()));
    for (const Map& m : material->maps()) {
      hasher_.add(m.name);
      (*this)(m.image);
    }
  }
  void operator()(const FeaturesPtr& features) {
    add(features->size());
    hasher_.add(features->wraps()).add(int64_t(features->images().size())).add(features->mask() != nullptr);
    features->repeats().add_to(hasher_);
    for (const FeatureImage& f : features->images()) {
      (*this)(f.image);
      numbers(f.weights);
    }
    if (features->mask()) (*this)(features->mask());
  }
  void operator()(const AppearancePtr& appearance) {
    hasher_.add(appearance->channels()).add(appearance->wraps()).add(int64_t(appearance->levels().size()));
    appearance->repeats().add_to(hasher_);
    if (appearance->fingerprint()) (*this)(*appearance->fingerprint());
    for (const AppearanceLevel& l : appearance->levels()) {
      add(l.size);
      hasher_.add(l.dimensions).add(l.scale).add(l.retained);
      bits(l.vectors);
      bits(l.usable);
      numbers(l.mean);
      bits(l.basis);
      for (const AppearanceVector& v : l.vectors)
        for (const int16_t component : v) numbers_.push_back(component);
    }
  }
  void operator()(const Fingerprint& fingerprint) {
    add(fingerprint.cells);
    for (const Fingerprint::Channel& c : fingerprint.channels) {
      hasher_.add(c.map).add(c.channel);
      numbers(c.means);
    }
  }
  void operator()(const IndexPtr& index) {
    (*this)(index->appearance());
    for (const SimilarSets& s : index->levels()) {
      hasher_.add(s.per_pixel);
      numbers(s.positions);
    }
  }
  void operator()(const UvMapPtr& uv) {
    add(uv->size());
    add(uv->exemplar());
    hasher_.add(uv->fingerprint() != nullptr);
    hasher_.add(uv->wraps().x).add(uv->wraps().y).add(uv->wraps().exemplar);
    for (const ExemplarPixel& p : uv->pixels()) {
      hasher_.add(int(p.x)).add(int(p.y));
      numbers_.insert(numbers_.end(), {double(p.x), double(p.y)});
    }
  }
  void operator()(const ReportPtr& report) {
    hasher_.add(report->title()).add(int64_t(report->figures().size()));
    for (const Report::Figure& f : report->figures()) {
      hasher_.add(f.name).add(f.help).add(int(f.value.index()));
      std::visit([this](const auto& v) { hasher_.add(v); }, f.value);
      if (const double* number = std::get_if<double>(&f.value)) numbers_.push_back(*number);
    }
    for (const Report::Picture& p : report->pictures()) {
      hasher_.add(p.name);
      (*this)(p.image);
    }
  }
  void operator()(const std::vector<uint8_t>& bytes) { numbers(bytes); }
  void operator()(const std::string& text) { hasher_.add(text); }

 private:
  void add(Size size) { hasher_.add(size.width).add(size.height); }
  void add(const Image& image) {
    const ImageInfo& info = image.info();
    add(info.size);
    hasher_.add(info.channels).add(name_of(info.semantic)).add(info.color_space).add(name_of(info.depth));
    hasher_.add(info.normal_y == NormalY::up);
  }
  template <typename T>
  void bits(const std::vector<T>& values) {
    hasher_.bytes(values.data(), values.size() * sizeof(T));
  }
  template <typename T>
  void numbers(const std::vector<T>& values) {
    bits(values);
    numbers_.insert(numbers_.end(), values.begin(), values.end());
  }

  Hasher hasher_;
  std::vector<double> numbers_;
};

/// What the file says of its pixels, but for what differs from run to run or with the writing library's version.
std::string description_of(const std::filesystem::path& path) {
  const auto in = OIIO::ImageInput::open(path.string());
  if (!in) return "";
  const OIIO::ImageSpec spec = in->spec();
  std::string out = fmt::format("{} {}", in->format_name(), spec.format.c_str());
  for (const std::string& name : spec.channelnames) out += " " + name;
  for (const char* name : {"oiio:ColorSpace", "ImageDescription", "oiio:UnassociatedAlpha", "compression"})
    out += fmt::format(" {}={}", name, spec.get_string_attribute(name));
  return out;
}

}  // namespace

Content content_of(const Value& value) {
  Reader reader;
  std::visit(reader, value);
  return reader.content();
}

Content content_of_file(const std::filesystem::path& path) {
  Reader reader;
  if (looks_like_image(path)) {
    reader(description_of(path));
    reader(read_image(path, {}, [](const std::string&) {}));
  } else if (path.extension() == ".analysis") {
    std::visit(reader, load_value(path));
  } else {
    reader(read_bytes(path));
  }
  return reader.content();
}

std::string library_versions() {
  const int color = OIIO::ColorConfig::OpenColorIO_version_hex();
  std::string out =
      fmt::format("OpenImageIO {}, OpenColorIO {}.{}.{}", OIIO::get_string_attribute("version", OIIO_VERSION_STRING),
                  color >> 24, color >> 16 & 0xff, color >> 8 & 0xff);
  const std::string formats = OIIO::get_string_attribute("library_list");
  for (size_t at = 0; at < formats.size();) {
    const size_t end = std::min(formats.find(';', at), formats.size());
    const std::string entry = formats.substr(at, end - at);
    for (const char* format : {"jpeg:", "openexr:", "png:", "tiff:"})
      if (entry.starts_with(format)) out += ", " + entry.substr(entry.find(':') + 1);
    at = end + 1;
  }
  return out;
}

}  // namespace terrazzo::test
