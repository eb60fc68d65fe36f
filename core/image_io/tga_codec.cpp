#include "core/image_io/tga_codec.h"

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image_io/format_facts.h"
#include "core/integrity/file_numbers.h"

namespace terrazzo {

namespace {

/// Facts from the header (Truevision TGA File Format Specification 2.0).
struct TgaLayout {
  enum : uint64_t { true_colour = 2, packed_true_colour = 10 };
  uint64_t type = 0, bits = 0, descriptor = 0, begin = 0;
  Size size;

  bool has_alpha_bit() const {
    constexpr uint64_t attribute_bits = 0xf;
    return (type == true_colour || type == packed_true_colour) && bits == 16 && (descriptor & attribute_bits) == 1;
  }
  bool from_right() const { return (descriptor & 0x10) != 0; }
  bool from_top() const { return (descriptor & 0x20) != 0; }
};

TgaLayout tga_layout_of(const FileNumbers& file) {
  TgaLayout tga{.type = file.number(2, 1),
                .bits = file.number(16, 1),
                .descriptor = file.number(17, 1),
                .size = {int(file.number(12, 2)), int(file.number(14, 2))}};
  const uint64_t palette = file.number(1, 1) == 1 ? file.number(5, 2) * ((file.number(7, 1) + 7) / 8) : 0;
  tga.begin = 18 + file.number(0, 1) + palette;
  return tga;
}

class TgaDecoder final : public ImageDecoder {
 public:
  TgaDecoder(const std::filesystem::path& path, const TgaLayout& layout) : path_(path), tga_(layout) {
    header_.format = "targa";
    header_.size = tga_.size;
    header_.stored = whole(header_.size);
    header_.channels = {"R", "G", "B", "A"};
    header_.type = "uint8";
  }
  const StoredImage& header() const override { return header_; }
  bool has_more_images() override { return false; }
  void read_rows(int, int, Depth, void*) override {}  // not by rows
  void read(Depth, void* out) override {
    const std::vector<uint16_t> pixels = unpacked();
    auto* to = static_cast<uint8_t*>(out);
    for (int y = 0; y < tga_.size.height; y++)
      for (int x = 0; x < tga_.size.width; x++) {
        const int from_x = tga_.from_right() ? tga_.size.width - 1 - x : x;
        const int from_y = tga_.from_top() ? y : tga_.size.height - 1 - y;
        const unsigned pixel = pixels[size_t(from_y) * size_t(tga_.size.width) + size_t(from_x)];
        for (const int shift : {10, 5, 0}) {
          const unsigned five = pixel >> shift & 31;
          *to++ = uint8_t(five << 3 | five >> 2);
        }
        *to++ = (pixel & 0x8000) != 0 ? 255 : 0;
      }
  }

 private:
  /// The pixels in the order of the file.
  std::vector<uint16_t> unpacked() const {
    const FileNumbers file(path_);
    const std::string bytes = file.text(tga_.begin, size_t(file.size()));
    const auto count = size_t(tga_.size.area());
    std::vector<uint16_t> out;
    out.reserve(count);
    size_t at = 0;
    const auto byte = [&] {
      if (at >= bytes.size()) throw Error("the end of the image is missing");
      return unsigned(uint8_t(bytes[at++]));
    };
    const auto pixel = [&] {
      const unsigned low = byte();
      return uint16_t(low | byte() << 8);
    };
    while (out.size() < count) {
      if (tga_.type == TgaLayout::true_colour) {
        out.push_back(pixel());
        continue;
      }
      const unsigned head = byte();
      const size_t run = std::min(size_t(head & 0x7f) + 1, count - out.size());
      if ((head & 0x80) != 0)
        out.insert(out.end(), run, pixel());
      else
        for (size_t i = 0; i < run; i++) out.push_back(pixel());
    }
    return out;
  }

  std::filesystem::path path_;
  TgaLayout tga_;
  StoredImage header_;
};

}  // namespace

std::unique_ptr<ImageDecoder> open_tga_with_alpha_bit(const std::filesystem::path& path) {
  if (lowercase(path.extension().string()) != ".tga") return nullptr;
  const FileNumbers file(path);
  const TgaLayout tga = tga_layout_of(file);
  if (!tga.has_alpha_bit() || format_facts(path).unused_alpha) return nullptr;
  return std::make_unique<TgaDecoder>(path, tga);
}

}  // namespace terrazzo
