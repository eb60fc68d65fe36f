#include "core/file/other_content.h"

#include <algorithm>
#include <array>
#include <fstream>

#include "core/base/text.h"

namespace terrazzo {

namespace {

struct Signature {
  std::string_view begins, is;
};
/// Images that are read are not among them.
constexpr std::array signatures = {
    Signature{"%PDF", "a PDF document"},
    Signature{"gimp xcf", "a GIMP document"},
    Signature{"PK\x03\x04", "a ZIP archive, as documents of Krita and office programs are too"},
    Signature{"\x1f\x8b", "a gzip archive"},
    Signature{"7z\xbc\xaf\x27\x1c", "a 7z archive"},
    Signature{"Rar!", "a RAR archive"},
    Signature{"version https://git-lfs", "a pointer of Git LFS (\"git lfs pull\" fetches the image)"},
    Signature{"BLENDER", "a Blender document"},
    Signature{"glTF", "a glTF model"},
};

/// Of a text that begins like that, after white space.
constexpr std::array markups = {
    Signature{"<!doctype html", "an HTML page, as a download that failed is"},
    Signature{"<html", "an HTML page, as a download that failed is"},
    Signature{"<svg", "an SVG drawing"},
    Signature{"<?xml", "an XML document"},
    Signature{"{", "a JSON document or other text"},
};

bool is_text(std::string_view bytes) {
  return std::ranges::none_of(
      bytes, [](unsigned char c) { return (c < ' ' && c != '\n' && c != '\r' && c != '\t') || c > '~'; });
}

}  // namespace

std::string other_content(const std::filesystem::path& path) {
  constexpr size_t looked_at = 64;
  std::string bytes(looked_at, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(bytes.data(), looked_at);
  bytes.resize(size_t(in.gcount()));
  for (const Signature& s : signatures)
    if (bytes.starts_with(s.begins)) return std::string(s.is);
  // Radiance, FITS and portable maps begin like text.
  const bool is_picture = bytes.starts_with("#?") || bytes.starts_with("SIMPLE  =") ||
                          (bytes.size() > 1 && bytes[0] == 'P' && is_digit(bytes[1]));
  if (bytes.empty() || is_picture || !is_text(bytes)) return "";
  const std::string text = lowercase(bytes.substr(std::min(bytes.size(), bytes.find_first_not_of(" \n\r\t"))));
  for (const Signature& s : markups)
    if (text.starts_with(s.begins)) return std::string(s.is);
  return "text";
}

}  // namespace terrazzo
