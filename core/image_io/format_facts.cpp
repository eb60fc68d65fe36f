#include "core/image_io/format_facts.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/integrity/file_integrity.h"
#include "core/integrity/file_numbers.h"

namespace terrazzo {

namespace {

FormatFacts refused(std::string why) {
  return {.refusal = std::move(why)};
}

FormatFacts refused_space(std::string_view space) {
  return refused(refusal_of_space(space));
}

FormatFacts tiff(const std::filesystem::path& path) {
  enum : int {
    white_is_zero = 0,
    rgb = 2,
    palette = 3,
    cielab = 8,
    icclab = 9,
    itulab = 10,
    cfa = 32803,
    logl = 32844,
    logluv
  };
  constexpr int is_unsigned = 1, is_float = 3, associated_alpha = 1;
  const TiffFacts tiff = read_tiff_facts(path);
  const auto is = [&](std::initializer_list<int> kinds) { return std::ranges::count(kinds, tiff.photometric) > 0; };
  if (is({cielab, icclab, itulab})) return refused_space("Lab");
  if (is({logl, logluv})) return refused_space("LogLuv");
  if (is({cfa})) return refused("it is a camera's raw data; develop it into an RGB image first");
  if (is({palette}) && tiff.samples > 1)
    return refused("it has a palette and another channel, which are not read together; save it as RGBA");
  if (tiff.format == is_float && tiff.bits == 24)
    return refused("its values are 24-bit floats; expected 16 or 32 bits: save it as 32-bit float");
  FormatFacts facts;
  const bool has_alpha = tiff.samples == 2 || tiff.samples == 4;
  if (is({white_is_zero})) {
    // The library inverts values of up to 8 bits, alpha included.
    constexpr int most_inverted_bits = 8;
    if (tiff.format != is_unsigned)
      return refused(
          "its photometric tag says that 0 is white, and its values have no range that says what black is; save it "
          "with black as 0");
    facts.inverted_colours = tiff.bits > most_inverted_bits;
    facts.inverted_alpha = has_alpha && !facts.inverted_colours;
  }
  facts.premultiplied = has_alpha && !tiff.extra_samples.empty() && tiff.extra_samples.front() == associated_alpha;
  if (tiff.samples == 4 && is({rgb}) && tiff.extra_samples.empty())
    facts.note = "it does not say what its fourth channel is; it is read as alpha that colours are not multiplied by";
  return facts;
}

/// Microsoft's BITMAPINFOHEADER and its successors.
FormatFacts bmp(const FileNumbers& file) {
  constexpr uint64_t size_of_info = 40, size_with_masks = 52, size_with_alpha = 56;
  enum : uint64_t { plain = 0, masks_follow = 3, four_masks_follow = 6 };
  const uint64_t header = file.number(14, 4), bits = file.number(28, 2), compression = file.number(30, 4);
  if (header < size_of_info || bits != 32) return {};
  if (compression == plain)
    return {.unused_alpha = true, .note = "the fourth byte of its pixels is unused, as its header says"};
  if (compression != masks_follow && compression != four_masks_follow) return {};
  std::array<uint64_t, 4> masks{};
  const bool has_alpha_mask = header >= size_with_alpha || compression == four_masks_follow;
  for (size_t i = 0; i < (has_alpha_mask ? 4 : 3); i++) masks[i] = file.number(14 + size_of_info + 4 * i, 4);
  static_assert(size_with_masks == size_of_info + 3 * 4);
  // The library assumes blue, green, red, alpha.
  if (masks[0] != 0xff0000 || masks[1] != 0xff00 || masks[2] != 0xff || (masks[3] != 0 && masks[3] != 0xff000000))
    return refused("its channels are not in the usual order (blue, green, red, alpha); save it as PNG");
  if (masks[3] != 0) return {};
  return {.unused_alpha = true, .note = "the fourth byte of its pixels is unused, as its header says"};
}

/// Truevision TGA File Format Specification 2.0.
FormatFacts tga(const FileNumbers& file) {
  constexpr uint64_t footer_size = 26, at_attributes_type = 494;
  enum : uint64_t { no_alpha = 0, ignore = 1, premultiplied = 4 };
  enum : uint64_t { grey = 3, packed_grey = 11, attribute_bits = 0xf };
  const uint64_t depth = file.number(16, 1), kind = file.number(2, 1);
  // The library reads the two bytes as 8-bit grey and alpha.
  if ((kind == grey || kind == packed_grey) && depth == 16 && (file.number(17, 1) & attribute_bits) == 0)
    return refused("its header says grey values of 16 bits, which TGA does not know; save it as 16-bit PNG");
  if ((depth != 32 && depth != 16) || file.size() < footer_size) return {};
  const uint64_t footer = file.size() - footer_size;
  if (file.text(footer + 8, 16) != "TRUEVISION-XFILE") return {};
  const uint64_t extension = file.number(footer, 4);
  if (extension == 0 || extension + at_attributes_type >= footer) return {};
  const uint64_t type = file.number(extension + at_attributes_type, 1);
  if (type == premultiplied) return {.premultiplied = true};
  if (type != no_alpha && type != ignore) return {};
  return {.unused_alpha = true, .note = "its extension area says that its fourth channel is not alpha"};
}

FormatFacts psd(const FileNumbers& file) {
  constexpr std::array<std::string_view, 10> modes = {"",        "",   "", "", "CMYK", "", "", "multichannel (inks)",
                                                      "duotone", "Lab"};
  const uint64_t mode = file.big_endian(24, 2);
  if (mode >= modes.size()) return refused("its header has an unknown colour mode");
  return modes[mode].empty() ? FormatFacts() : refused_space(modes[mode]);
}

/// Microsoft's "Programming Guide for DDS".
FormatFacts dds(const FileNumbers& file) {
  enum : uint64_t { alpha_only = 0x2, four_cc = 0x4, rgb = 0x40, luminance = 0x20000 };
  constexpr uint64_t is_cube = 0x200, is_volume = 0x200000, dx10_cube = 0x4;
  const uint64_t flags = file.number(80, 4);
  const std::string code = file.text(84, 4);
  const bool has_dx10 = (flags & four_cc) != 0 && code == "DX10";
  if ((file.number(112, 4) & is_cube) != 0 || (has_dx10 && (file.number(136, 4) & dx10_cube) != 0))
    return refused("it is a cube map; expected a flat picture: save the wanted face as a separate file");
  if ((file.number(112, 4) & is_volume) != 0)
    return refused(fmt::format("it is a volume of {} slices; expected a flat picture", file.number(24, 4)));
  if (const uint64_t images = has_dx10 ? file.number(140, 4) : 1; images > 1)
    return refused(
        fmt::format("it is an array of {} images; expected one: save the wanted one as a separate file", images));
  if ((flags & four_cc) != 0) {
    if (code == "DXT2" || code == "DXT4")
      return refused(fmt::format("it is {}, whose colours are multiplied by alpha; save it as DXT5 or PNG", code));
    // BC4, BC5, BC6H (both), BC7.
    if (has_dx10 && std::ranges::count(std::array{80, 83, 95, 96, 98}, file.number(128, 4)) == 0)
      return refused(
          fmt::format("its format, number {} of DXGI, is not supported; save it as PNG or EXR, or with "
                      "the header of DirectX 9 as DXT1, DXT5 or BC5U",
                      file.number(128, 4)));
    constexpr std::array<std::string_view, 9> known = {"DXT1", "DXT3", "DXT5", "ATI1", "ATI2",
                                                       "BC4U", "BC5U", "RXGB", "DX10"};
    if (std::ranges::find(known, code) == known.end())
      return refused("the format of its pixels is not supported; save it as PNG or EXR, or as DXT1, DXT5 or BC5U");
    return {};
  }
  std::array<uint64_t, 3> masks{};
  for (size_t i = 0; i < masks.size(); i++) masks[i] = file.number(92 + 4 * i, 4);
  const auto is_readable = [](uint64_t mask) {
    if (mask == 0) return false;
    while ((mask & 1) == 0) mask >>= 1;
    return mask <= 0xff;
  };
  // The library hangs if a colour has no mask, and truncates values of more than 8 bits.
  const bool has_colours = (flags & rgb) != 0 && std::ranges::all_of(masks, is_readable);
  const bool is_grey = (flags & luminance) != 0 && is_readable(masks[0]);
  const bool is_alpha = (flags & (alpha_only | rgb | luminance)) == alpha_only;
  if (has_colours || is_grey || is_alpha) return {};
  return refused(
      "its pixels are neither compressed nor red, green and blue of at most 8 bits; save it as PNG, EXR or BC5");
}

/// The extended header of Google's "WebP Container Specification". Only OpenImageIO reads a frame of animated files,
/// and it multiplies colours by alpha.
FormatFacts webp(const FileNumbers& file) {
  constexpr uint64_t is_animated = 0x2, has_alpha = 0x10, both = is_animated | has_alpha;
  if (file.text(12, 4) != "VP8X" || (file.number(20, 1) & both) != both) return {};
  return refused("it is an animation with alpha; expected a single picture: save the wanted frame as PNG");
}

/// Whether the first colour specification in the header box (ITU T.800, annex I) names a space other than sRGB, grey
/// and sYCC.
FormatFacts jpeg2000(const FileNumbers& file) {
  enum : uint64_t { cmyk = 12, lab = 14, srgb = 16, grey = 17, sycc = 18 };
  constexpr size_t most_header = 4096, after_name = 7;
  const std::string head = file.text(0, most_header);
  const size_t box = head.find("colr");
  if (box == head.npos || file.number(box + 4, 1) != 1) return {};
  const uint64_t space = file.big_endian(box + after_name, 4);
  if (space == cmyk) return refused_space("CMYK");
  if (space == lab) return refused_space("Lab");
  if (space == srgb || space == grey || space == sycc) return {};
  return refused_space(fmt::format("of the colour space {} (T.800)", space));
}

}  // namespace

std::string refusal_of_space(std::string_view space) {
  return fmt::format("it is {}; expected RGB or grey: convert it to RGB in an image editor first", space);
}

FormatFacts format_facts(const std::filesystem::path& path) {
  const FileNumbers file(path);
  const std::string start = file.text(0, 12);
  const auto begins = [&](std::string_view with) { return std::string_view(start).starts_with(with); };
  if (begins("II") || begins("MM")) return tiff(path);
  if (begins("BM")) return bmp(file);
  if (begins("8BPS")) return psd(file);
  if (begins("DDS ")) return dds(file);
  if (begins({"\0\0\0\x0cjP  ", 8})) return jpeg2000(file);
  if (begins("RIFF") && start.ends_with("WEBP")) return webp(file);
  if (begins("SIMPLE  ="))
    return refused(
        "it is FITS, whose numbers have no range that says what black and white are; save it as TIFF or EXR of floats");
  // TGA files have no signature.
  return lowercase(path.extension().string()) == ".tga" ? tga(file) : FormatFacts();
}

}  // namespace terrazzo
