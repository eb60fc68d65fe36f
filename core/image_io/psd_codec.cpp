#include "core/image_io/psd_codec.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/integrity/file_numbers.h"

namespace terrazzo {

namespace {

enum : uint64_t { grey = 1, indexed = 2, rgb = 3 };
constexpr size_t palette_size = 256;

/// Facts from before the composite, and where that begins.
struct PsdLayout {
  bool is_big = false;  ///< PSB: lengths have twice as many bytes
  int channels = 0, bits = 0;
  Size size;
  uint64_t mode = 0;
  uint64_t palette = 0;
  bool has_transparency = false;  ///< the first channel after the colours is the layers' transparency
  uint64_t composite = 0;

  int colours() const { return mode == rgb ? 3 : 1; }
  bool has_alpha() const { return channels > colours(); }
  int read_channels() const { return (mode == indexed ? 3 : colours()) + (has_alpha() ? 1 : 0); }
  size_t bytes() const { return size_t(bits) / 8; }
};

/// Whether the tagged blocks from `at` to `end` say that the composite is transparent, as in files of 16 and 32 bits.
bool says_transparency(const FileNumbers& file, const PsdLayout& psd, uint64_t at, uint64_t end) {
  constexpr std::array<std::string_view, 8> long_keys = {"LMsk", "Lr16", "Lr32", "Layr",
                                                         "Mt16", "Mt32", "Mtrn", "Alph"};
  while (at + 12 <= end) {
    const std::string key = file.text(at + 4, 4);
    if (key == "Mtrn" || key == "Mt16" || key == "Mt32") return true;
    const bool is_long = psd.is_big && std::ranges::find(long_keys, key) != long_keys.end();
    const uint64_t length = file.big_endian(at + 8, is_long ? 8 : 4);
    if (length > end - at) return false;
    at += 8 + (is_long ? 8 : 4) + (length + 3) / 4 * 4;
  }
  return false;
}

PsdLayout psd_layout_of(const FileNumbers& file) {
  PsdLayout psd;
  psd.is_big = file.big_endian(4, 2) == 2;
  psd.channels = int(file.big_endian(12, 2));
  psd.size = {int(file.big_endian(18, 4)), int(file.big_endian(14, 4))};
  psd.bits = int(file.big_endian(22, 2));
  psd.mode = file.big_endian(24, 2);
  constexpr uint64_t at_palette_length = 26;
  psd.palette = at_palette_length + 4;
  const uint64_t resources = psd.palette + file.big_endian(at_palette_length, 4);
  const uint64_t layers = resources + 4 + file.big_endian(resources, 4);
  const int word = psd.is_big ? 8 : 4;
  const uint64_t begin = layers + word, end = begin + file.big_endian(layers, word);
  psd.composite = end;
  if (end == begin) return psd;
  const uint64_t info = file.big_endian(begin, word), masks = begin + word + info;
  const bool is_negative = info >= 2 && (file.big_endian(begin + word, 2) & 0x8000) != 0;
  psd.has_transparency =
      is_negative || (masks < end && says_transparency(file, psd, masks + 4 + file.big_endian(masks, 4), end));
  return psd;
}

/// Apple's PackBits. Returns the end of the input that gave `size` bytes; null if there are fewer.
const uint8_t* unpack_bits(const uint8_t* in, const uint8_t* in_end, uint8_t* out, size_t size) {
  const uint8_t* const out_end = out + size;
  while (out < out_end) {
    if (in == in_end) return nullptr;
    const int head = int8_t(*in++);  // NOLINT(bugprone-signed-char-misuse): a signed number
    if (head == -128) continue;
    const auto count = size_t(head < 0 ? 1 - head : head + 1);
    if (count > size_t(out_end - out) || (head < 0 ? 1 : count) > size_t(in_end - in)) return nullptr;
    if (head < 0)
      std::memset(out, *in, count);
    else
      std::memcpy(out, in, count);
    in += head < 0 ? 1 : count;
    out += count;
  }
  return in;
}

/// Removes the white onto which a colour was blended.
template <typename T>
void part_from_white(T* pixels, int64_t count, int channels) {
  constexpr bool is_float = std::is_floating_point_v<T>;
  using Wide = std::conditional_t<is_float, double, int64_t>;
  const Wide white = is_float ? 1 : Wide(std::numeric_limits<T>::max());
  for (int64_t i = 0; i < count; i++, pixels += channels) {
    const Wide alpha = Wide(pixels[channels - 1]);
    if (alpha <= 0) continue;
    for (int c = 0; c < channels - 1; c++) {
      const Wide behind = Wide(pixels[c]) - (white - alpha);
      pixels[c] = T(std::clamp<Wide>((behind * white + (is_float ? 0 : alpha / 2)) / alpha, 0, white));
    }
  }
}

class PsdDecoder final : public ImageDecoder {
 public:
  PsdDecoder(const std::filesystem::path& path, const PsdLayout& layout) : path_(path), psd_(layout) {
    header_.format = "psd";
    header_.size = psd_.size;
    header_.stored = whole(header_.size);
    header_.channels =
        psd_.read_channels() <= 2 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
    if (psd_.has_alpha()) header_.channels.emplace_back("A");
    header_.depth = psd_.bits == 8 ? Depth::u8 : psd_.bits == 16 ? Depth::u16 : Depth::f32;
    header_.type = psd_.bits == 8 ? "uint8" : psd_.bits == 16 ? "uint16" : "float";
    if (psd_.has_alpha() && psd_.has_transparency)
      header_.note = "its layers' transparency blends its colours with white; the white was removed";
    else if (psd_.channels > psd_.colours() + 1)
      header_.note = "of its extra channels the first is read, as alpha";
  }
  const StoredImage& header() const override { return header_; }
  bool has_more_images() override { return false; }
  void read_rows(int, int, Depth, void*) override {}  // not by rows
  void read(Depth, void* out) override {
    const int used = psd_.colours() + (psd_.has_alpha() ? 1 : 0);
    const std::vector<uint8_t> planes = read_planes(used);
    const auto values = [&](auto zero) { interleave<decltype(zero)>(planes, out); };
    psd_.bits == 8 ? values(uint8_t{}) : psd_.bits == 16 ? values(uint16_t{}) : values(float{});
  }

 private:
  [[noreturn]] static void fail() { throw Error("the end of its composite is missing"); }

  /// The first planes of the composite, big endian.
  std::vector<uint8_t> read_planes(int count) const {
    const FileNumbers file(path_);
    const size_t row = size_t(psd_.size.width) * psd_.bytes();
    const size_t rows = size_t(psd_.size.height) * size_t(count);
    const uint64_t compression = file.big_endian(psd_.composite, 2), begin = psd_.composite + 2;
    std::vector<uint8_t> out(row * rows);
    enum : uint64_t { raw = 0, packbits = 1 };
    if (compression == raw) {
      const std::string bytes = file.text(begin, out.size());
      if (bytes.size() < out.size()) fail();
      std::memcpy(out.data(), bytes.data(), bytes.size());
      return out;
    }
    if (compression != packbits)
      throw Error(fmt::format("its composite has the compression {}, which is not known", compression));
    // A table of the rows' lengths comes first.
    const uint64_t all_rows = uint64_t(psd_.size.height) * uint64_t(psd_.channels);
    const std::string packed = file.text(begin + all_rows * (psd_.is_big ? 4 : 2), size_t(file.size()));
    const auto* in = reinterpret_cast<const uint8_t*>(packed.data());
    const uint8_t* const end = in + packed.size();
    for (size_t y = 0; y < rows; y++)
      if (in = unpack_bits(in, end, out.data() + y * row, row); !in) fail();
    return out;
  }

  template <typename T>
  static T value_at(const uint8_t* from) {
    std::array<uint8_t, sizeof(T)> bytes{};
    std::copy_n(from, sizeof(T), bytes.begin());
    if constexpr (std::endian::native == std::endian::little) std::ranges::reverse(bytes);
    return std::bit_cast<T>(bytes);
  }

  template <typename T>
  void interleave(const std::vector<uint8_t>& planes, void* out) const {
    const int64_t pixels = psd_.size.area();
    const int channels = psd_.read_channels();
    auto* to = static_cast<T*>(out);
    const auto copy = [&](int from, int channel) {
      const uint8_t* plane = planes.data() + size_t(from) * size_t(pixels) * sizeof(T);
      for (int64_t i = 0; i < pixels; i++) to[i * channels + channel] = value_at<T>(plane + size_t(i) * sizeof(T));
    };
    if (psd_.mode == indexed)
      expand_palette(planes, to, channels);
    else
      for (int c = 0; c < psd_.colours(); c++) copy(c, c);
    if (!psd_.has_alpha()) return;
    copy(psd_.colours(), channels - 1);
    if (psd_.has_transparency) part_from_white(to, pixels, channels);
  }

  template <typename T>
  void expand_palette(const std::vector<uint8_t>& indices, T* to, int channels) const {
    const std::string palette = FileNumbers(path_).text(psd_.palette, 3 * palette_size);
    if (palette.size() < 3 * palette_size) fail();
    for (int64_t i = 0; i < psd_.size.area(); i++)
      for (int c = 0; c < 3; c++)
        to[i * channels + c] = T(uint8_t(palette[size_t(c) * palette_size + indices[size_t(i)]]));
  }

  std::filesystem::path path_;
  PsdLayout psd_;
  StoredImage header_;
};

}  // namespace

std::unique_ptr<ImageDecoder> open_psd(const std::filesystem::path& path) {
  const FileNumbers file(path);
  if (file.text(0, 4) != "8BPS") return nullptr;
  const PsdLayout psd = psd_layout_of(file);
  const bool is_known = psd.mode == grey || psd.mode == rgb || (psd.mode == indexed && psd.bits == 8);
  const bool has_bits = psd.bits == 8 || psd.bits == 16 || psd.bits == 32;
  if (!is_known || !has_bits || psd.channels < psd.colours()) return nullptr;
  return std::make_unique<PsdDecoder>(path, psd);
}

}  // namespace terrazzo
