#include "core/image_io/png_codec.h"

#include <array>
#include <bit>
#include <cerrno>
#include <csetjmp>
#include <cstdio>

#include <png.h>
#include <zlib.h>

#include "core/base/error.h"
#include "core/file/file_io.h"

namespace terrazzo {

namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using CFile = std::unique_ptr<std::FILE, CloseFile>;

/// libpng's error function. It must not return, so it jumps back to where reading or writing began.
[[noreturn]] void keep_reason(png_structp png, const char* reason) {
  auto& kept = *static_cast<std::array<char, 200>*>(png_get_error_ptr(png));
  std::snprintf(kept.data(), kept.size(), "%s", reason);
  png_longjmp(png, 1);
}

/// Warnings are about text, time and profiles, none of which is used.
void ignore_warning(png_structp, const char*) {}

class PngDecoder final : public ImageDecoder {
 public:
  explicit PngDecoder(CFile file) : file_(std::move(file)) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reason_, keep_reason, ignore_warning);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
  }
  ~PngDecoder() override { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngDecoder(const PngDecoder&) = delete;
  PngDecoder& operator=(const PngDecoder&) = delete;

  bool is_png() const {
    std::array<png_byte, 8> start{};
    const size_t got = std::fread(start.data(), 1, start.size(), file_.get());
    std::rewind(file_.get());
    return png_sig_cmp(start.data(), 0, got) == 0;
  }
  void read_header() {
    if (!info_ || !read_info()) throw Error(reason_.data());
    header_.format = "png";
    header_.size = {int(png_get_image_width(png_, info_)), int(png_get_image_height(png_, info_))};
    header_.stored = whole(header_.size);
    header_.channels.resize(png_get_channels(png_, info_));
    header_.depth = png_get_bit_depth(png_, info_) == 16 ? Depth::u16 : Depth::u8;
    header_.by_rows = png_get_interlace_type(png_, info_) == PNG_INTERLACE_NONE;
    png_textp texts = nullptr;
    int count = 0;
    png_get_text(png_, info_, &texts, &count);
    for (int i = 0; i < count; i++)
      if (const std::string_view key = texts[i].key; key == "Description" || key == "ImageDescription")
        header_.description = texts[i].text;
    if (says_linear()) header_.color_space = "lin_rec709";
  }
  bool may_be_turned() const { return png_get_valid(png_, info_, PNG_INFO_eXIf) != 0; }
  const StoredImage& header() const override { return header_; }
  bool has_more_images() override { return false; }
  void read(Depth, void* out) override {
    const size_t row = png_get_rowbytes(png_, info_);
    std::vector<png_bytep> rows(size_t(header_.size.height));
    for (size_t y = 0; y < rows.size(); y++) rows[y] = static_cast<png_bytep>(out) + y * row;
    if (!read_all(rows.data())) throw Error(reason_.data());
  }
  void read_rows(int first, int end, Depth, void* out) override {
    if (!read_some(static_cast<png_bytep>(out), end - first, end == header_.size.height)) throw Error(reason_.data());
  }

 private:
  /// Chunks that name a colour space take precedence over gAMA (PNG, third edition, 4.3).
  bool says_linear() const {
    double gamma = 0;
    const png_uint_32 others = PNG_INFO_sRGB | PNG_INFO_iCCP;
    return png_get_valid(png_, info_, others) == 0 && png_get_gAMA(png_, info_, &gamma) != 0 && gamma == 1;
  }

  // Nothing in these three needs destroying when libpng jumps out of them.
  bool read_info() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_init_io(png_, file_.get());
    png_read_info(png_, info_);
    const int color = png_get_color_type(png_, info_);
    if (color == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png_);
    if (color == PNG_COLOR_TYPE_GRAY) png_set_expand_gray_1_2_4_to_8(png_);
    if (png_get_valid(png_, info_, PNG_INFO_tRNS) != 0) png_set_tRNS_to_alpha(png_);
    if constexpr (std::endian::native == std::endian::little) png_set_swap(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }
  bool read_all(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }
  bool read_some(png_bytep out, int rows, bool to_the_end) {
    if (setjmp(png_jmpbuf(png_))) return false;
    const size_t row_bytes = png_get_rowbytes(png_, info_);
    for (int y = 0; y < rows; y++) png_read_row(png_, out + size_t(y) * row_bytes, nullptr);
    if (to_the_end) png_read_end(png_, nullptr);
    return true;
  }

  CFile file_;
  std::array<char, 200> reason_{};
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  StoredImage header_;
};

class PngEncoder final : public ImageEncoder {
 public:
  PngEncoder(const EncodedImage& image, ByteSink& sink) : image_(image), sink_(sink) {
    png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, &reason_, keep_reason, ignore_warning);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
  }
  ~PngEncoder() override { png_destroy_write_struct(&png_, &info_); }
  PngEncoder(const PngEncoder&) = delete;
  PngEncoder& operator=(const PngEncoder&) = delete;

  void begin() { require(info_ && write_header()); }
  void write_rows(int first, int end, const void* values) override {
    require(write_some(static_cast<png_const_bytep>(values), end - first));
  }
  void finish() override { require(write_end()); }

 private:
  static void put(png_structp png, png_bytep data, size_t size) {
    auto& encoder = *static_cast<PngEncoder*>(png_get_io_ptr(png));
    if (!encoder.sink_.write(encoder.written_, data, size)) png_error(png, "the file takes no more");
    encoder.written_ += size;
  }
  static void flush(png_structp) {}

  void require(bool done) const {
    if (!done) throw Error(reason_.data());
  }

  // Nothing in these three needs destroying when libpng jumps out of them.
  bool write_header() {
    constexpr std::array types = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                  PNG_COLOR_TYPE_RGB_ALPHA};
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_write_fn(png_, this, put, flush);
    png_set_IHDR(png_, info_, png_uint_32(image_.size.width), png_uint_32(image_.size.height),
                 image_.options.depth == Depth::u16 ? 16 : 8, types[size_t(image_.channels - 1)], PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    // What the Paeth filter leaves of textures has no repeats worth a search, only runs: quicker, and smaller files.
    png_set_compression_level(png_, 1);
    png_set_compression_strategy(png_, Z_RLE);
    png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_PAETH);
    if (image_.color_space == "srgb_texture") png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_ABSOLUTE);
    if (image_.color_space == "lin_rec709") png_set_gAMA(png_, info_, 1.0);
    if (!image_.options.description.empty()) {
      png_text text{};
      text.compression = PNG_TEXT_COMPRESSION_NONE;
      text.key = const_cast<char*>("Description");
      text.text = image_.options.description.data();
      text.text_length = image_.options.description.size();
      png_set_text(png_, info_, &text, 1);
    }
    png_write_info(png_, info_);
    if constexpr (std::endian::native == std::endian::little) png_set_swap(png_);
    return true;
  }
  bool write_some(png_const_bytep values, int rows) {
    if (setjmp(png_jmpbuf(png_))) return false;
    const size_t row_bytes = png_get_rowbytes(png_, info_);
    for (int y = 0; y < rows; y++) png_write_row(png_, values + size_t(y) * row_bytes);
    return true;
  }
  bool write_end() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_write_end(png_, info_);
    return true;
  }

  EncodedImage image_;
  ByteSink& sink_;
  uint64_t written_ = 0;
  std::array<char, 200> reason_{};
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

}  // namespace

std::unique_ptr<ImageDecoder> open_png(const std::filesystem::path& path) {
  CFile file(std::fopen(path.c_str(), "rbe"));
  if (!file && errno == EMFILE) throw_system_error("read", path, EMFILE);
  if (!file) return nullptr;
  auto decoder = std::make_unique<PngDecoder>(std::move(file));
  if (!decoder->is_png()) return nullptr;
  decoder->read_header();
  if (decoder->may_be_turned()) return nullptr;
  return decoder;
}

std::unique_ptr<ImageEncoder> create_png(const EncodedImage& image, ByteSink& sink) {
  auto encoder = std::make_unique<PngEncoder>(image, sink);
  encoder->begin();
  return encoder;
}

}  // namespace terrazzo
