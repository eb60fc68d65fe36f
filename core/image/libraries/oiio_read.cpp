#include <algorithm>

#include <OpenImageIO/imageio.h>

#include "core/base/error.h"
#include "core/image/libraries/parts.h"

namespace terrazzo {

namespace {

Depth depth_of(const OIIO::ImageSpec& spec) {
  if (!spec.channelformats.empty()) return Depth::f32;  // channels of different depths
  if (spec.format == OIIO::TypeDesc::HALF) return Depth::f16;
  if (spec.format == OIIO::TypeDesc::UINT8) return Depth::u8;
  if (spec.format == OIIO::TypeDesc::UINT16) return Depth::u16;
  return Depth::f32;
}

bool says_inks(const OIIO::ImageSpec& spec) {
  return spec.get_string_attribute("tiff:ColorSpace") == "CMYK" ||
         spec.get_int_attribute("tiff:PhotometricInterpretation", -1) == 5 ||
         spec.get_string_attribute("oiio:ColorSpace") == "CMYK";
}

StoredImage describe(const OIIO::ImageSpec& spec, const std::string& format) {
  StoredImage header;
  header.format = format;
  header.stored = {0, 0, spec.width, spec.height};
  header.size = {spec.width, spec.height};
  if (format == "openexr") {
    header.stored = {spec.x - spec.full_x, spec.y - spec.full_y, spec.width, spec.height};
    header.size = {spec.full_width, spec.full_height};
  }
  header.slices = spec.depth;
  header.orientation = std::clamp(spec.get_int_attribute("Orientation", 1), 1, 8);
  header.channels = spec.channelnames;
  header.channels.resize(std::max(0, spec.nchannels));
  header.depth = depth_of(spec);
  header.type = spec.channelformats.empty() ? spec.format.c_str() : "mixed depth";
  header.exact = header.depth != Depth::f32 || spec.format == OIIO::TypeDesc::FLOAT;
  header.deep = spec.deep;
  header.inks = says_inks(spec);
  header.description = std::string(spec.get_string_attribute("ImageDescription"));
  return header;
}

class OiioDecoder final : public ImageDecoder {
 public:
  explicit OiioDecoder(const std::string& path) {
    OIIO::ImageSpec wishes;
    wishes.attribute("oiio:UnassociatedAlpha", 1);
    in_ = OIIO::ImageInput::open(path, &wishes);
    if (!in_) throw Error(OIIO::geterror());
    in_->threads(1);
    header_ = describe(in_->spec(), in_->format_name());
  }
  const StoredImage& header() const override { return header_; }
  bool has_more_images() override {
    const bool more = in_->seek_subimage(1, 0);
    if (more) in_->seek_subimage(0, 0);
    return more;
  }
  void read(Depth as, void* out) override {
    constexpr std::array types = {OIIO::TypeDesc::UINT8, OIIO::TypeDesc::UINT16, OIIO::TypeDesc::HALF,
                                  OIIO::TypeDesc::FLOAT};
    const OIIO::TypeDesc type = types[static_cast<size_t>(as)];
    if (!in_->read_image(0, 0, 0, in_->spec().nchannels, type, out)) throw Error(in_->geterror());
  }

 private:
  std::unique_ptr<OIIO::ImageInput> in_;
  StoredImage header_;
};

}  // namespace

std::unique_ptr<ImageDecoder> open_with_oiio(const std::string& path) {
  return std::make_unique<OiioDecoder>(path);
}

}  // namespace terrazzo
