#include <algorithm>
#include <cstring>
#include <memory>
#include <numeric>
#include <optional>
#include <string>

#include <OpenImageIO/imageio.h>

#include "core/base/error.h"
#include "core/image_io/libraries/exr_layers.h"
#include "core/image_io/libraries/parts.h"

namespace terrazzo {

namespace {

Depth depth_of(const OIIO::TypeDesc& type) {
  if (type == OIIO::TypeDesc::HALF) return Depth::f16;
  if (type == OIIO::TypeDesc::UINT8) return Depth::u8;
  if (type == OIIO::TypeDesc::UINT16) return Depth::u16;
  return Depth::f32;
}

/// Nullopt if the channels are of several types.
std::optional<OIIO::TypeDesc> type_of(const OIIO::ImageSpec& spec, const std::vector<int>& channels) {
  if (channels.empty()) return spec.format;
  const OIIO::TypeDesc type = spec.channelformat(channels.front());
  for (const int c : channels)
    if (spec.channelformat(c) != type) return std::nullopt;
  return type;
}

bool says_inks(const OIIO::ImageSpec& spec) {
  return spec.get_string_attribute("tiff:ColorSpace") == "CMYK" ||
         spec.get_int_attribute("tiff:PhotometricInterpretation", -1) == 5 ||
         spec.get_string_attribute("oiio:ColorSpace") == "CMYK";
}

/// The data window of an EXR file, in coordinates of its display window.
Rect data_window(const OIIO::ImageSpec& spec) {
  return {spec.x - spec.full_x, spec.y - spec.full_y, spec.width, spec.height};
}

StoredImage describe(const OIIO::ImageSpec& spec, const std::string& format, const std::vector<int>& channels) {
  StoredImage header;
  header.format = format;
  header.stored = {0, 0, spec.width, spec.height};
  header.size = {spec.width, spec.height};
  if (format == "openexr") {
    header.stored = data_window(spec);
    header.left = spec.full_x;
    header.top = spec.full_y;
    header.size = {spec.full_width, spec.full_height};
  }
  header.slices = spec.depth;
  header.orientation = std::clamp(spec.get_int_attribute("Orientation", 1), 1, 8);
  for (const int c : channels) header.channels.push_back(spec.channel_name(c));
  const std::optional<OIIO::TypeDesc> type = type_of(spec, channels);
  header.depth = type ? depth_of(*type) : Depth::f32;
  header.type = type ? type->c_str() : "mixed depth";
  header.exact = header.depth != Depth::f32 || type == OIIO::TypeDesc::FLOAT;
  header.deep = spec.deep;
  header.inks = says_inks(spec);
  header.by_rows = format == "openexr" || format == "tiff" || format == "jpeg";
  header.description = std::string(spec.get_string_attribute("ImageDescription"));
  if (format == "png" && spec.get_string_attribute("oiio:ColorSpace") == "Linear") header.color_space = "lin_rec709";
  if (format == "targa" && header.channels.size() == 2) header.channels = {"Y", "A"};  // the library says R and G
  return header;
}

class OiioDecoder final : public ImageDecoder {
 public:
  explicit OiioDecoder(const std::string& path) : path_(path) {
    OIIO::ImageSpec wishes;
    wishes.attribute("oiio:UnassociatedAlpha", 1);
    in_ = OIIO::ImageInput::open(path, &wishes);
    if (!in_) throw Error(OIIO::geterror());
    in_->threads(1);
    find_layers();
    OiioDecoder::select(0);
  }
  const StoredImage& header() const override { return header_; }
  bool has_more_images() override {
    if (layers_.size() > 1) return false;
    // Not by `in_`: the library (2.4) cannot decode a WebP file any more once it has looked for further images.
    const std::unique_ptr<OIIO::ImageInput> again = OIIO::ImageInput::open(path_);
    return again && again->seek_subimage(1, 0);
  }
  std::vector<std::string> layers() const override {
    std::vector<std::string> names;
    for (const ExrLayer& l : layers_) names.push_back(l.name);
    return names;
  }
  void select(size_t index) override {
    layer_ = &layers_.at(index);
    in_->seek_subimage(layer_->part, 0);
    header_ = describe(in_->spec(), in_->format_name(), layer_->channels);
    header_.stored_differs = windows_differ_;
  }
  void drop_alpha() override {
    if (layer_->channels.size() % 2 != 0) return;
    layers_[size_t(layer_ - layers_.data())].channels.pop_back();
    header_.channels.pop_back();
  }
  void read(Depth as, void* out) override {
    // The library (2.4) always multiplies colours by alpha.
    if (header_.format == "webp" && header_.channels.size() == 4) return read_webp(path_, header_.size, out);
    read_layer(as, header_.stored.height, out, [&](int begin, int end, const OIIO::TypeDesc& type, void* to) {
      return in_->read_image(layer_->part, 0, begin, end, type, to);
    });
  }
  void read_rows(int first, int end, Depth as, void* out) override {
    const OIIO::ImageSpec& spec = in_->spec();
    const int top = spec.y + first, bottom = spec.y + end;
    read_layer(as, end - first, out, [&](int begin, int last, const OIIO::TypeDesc& type, void* to) {
      if (spec.tile_width > 0)
        return in_->read_tiles(layer_->part, 0, spec.x, spec.x + spec.width, top, bottom, spec.z, spec.z + 1, begin,
                               last, type, to);
      return in_->read_scanlines(layer_->part, 0, top, bottom, spec.z, begin, last, type, to);
    });
  }
  int row_step() const override { return std::max(1, in_->spec().tile_height); }

 private:
  /// Reads rows of the layer's channels by means of `read`, which reads a range of channels.
  template <typename Read>
  void read_layer(Depth as, int rows, void* out, const Read& read) {
    constexpr std::array types = {OIIO::TypeDesc::UINT8, OIIO::TypeDesc::UINT16, OIIO::TypeDesc::HALF,
                                  OIIO::TypeDesc::FLOAT};
    const OIIO::TypeDesc type = types[static_cast<size_t>(as)];
    const std::vector<int>& channels = layer_->channels;
    const auto [least, most] = std::minmax_element(channels.begin(), channels.end());
    const int first = *least, count = *most + 1 - first;
    const auto read_channels = [&](void* to) {
      in_->geterror();  // clears errors of opening
      const bool done = read(first, first + count, type, to);
      // Decoders that fill in for damaged data report success and an error.
      if (const std::string said = in_->geterror(); !done || !said.empty()) throw Error(said);
    };
    const bool in_order = std::is_sorted(channels.begin(), channels.end()) && count == int(channels.size());
    if (in_order) return read_channels(out);
    const int64_t pixels = int64_t{header_.stored.width} * rows;
    std::vector<uint8_t> all(size_t(pixels) * count * type.size());
    read_channels(all.data());
    auto* to = static_cast<uint8_t*>(out);
    for (int64_t i = 0; i < pixels; i++)
      for (const int c : channels) {
        std::memcpy(to, &all[(size_t(i) * count + (c - first)) * type.size()], type.size());
        to += type.size();
      }
  }

  void find_layers() {
    std::vector<ExrPart> parts;
    const Rect first = data_window(in_->spec());
    const bool may_have_layers = std::string_view(in_->format_name()) == "openexr";
    do {
      const OIIO::ImageSpec& spec = in_->spec();
      std::vector<std::string> channels = spec.channelnames;
      channels.resize(std::max(0, spec.nchannels));
      windows_differ_ |= data_window(spec) != first;
      parts.push_back({std::string(spec.get_string_attribute("oiio:subimagename")), std::move(channels)});
    } while (may_have_layers && in_->seek_subimage(int(parts.size()), 0));
    if (may_have_layers) layers_ = exr_layers(parts);
    if (!layers_.empty()) return;
    layers_ = {{"", 0, std::vector<int>(parts.front().channels.size())}};
    std::iota(layers_.front().channels.begin(), layers_.front().channels.end(), 0);
  }

  std::string path_;
  std::unique_ptr<OIIO::ImageInput> in_;
  std::vector<ExrLayer> layers_;
  const ExrLayer* layer_ = nullptr;
  bool windows_differ_ = false;
  StoredImage header_;
};

}  // namespace

std::unique_ptr<ImageDecoder> open_with_oiio(const std::string& path) {
  return std::make_unique<OiioDecoder>(path);
}

}  // namespace terrazzo
