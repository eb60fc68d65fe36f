#include "core/material/map_description.h"

#include <charconv>
#include <sstream>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/image_io/color.h"

namespace terrazzo {

namespace {

constexpr std::string_view mark = "terrazzo:";

/// "roughness=1-a".
std::optional<DescribedMap> packed_map(std::string_view name, std::string_view place) {
  constexpr std::string_view inversion = "1-";
  const std::optional<Semantic> semantic = semantic_of_map(std::string(name));
  const bool inverted = place.starts_with(inversion);
  if (inverted) place.remove_prefix(inversion.size());
  const bool are_channels = !place.empty() && place.size() <= 4 && place.find_first_not_of("rgba") == place.npos;
  if (!semantic || !are_channels) return std::nullopt;
  return DescribedMap{std::string(name), *semantic, std::string(place), inverted};
}

PhysicalSize metres_in(std::string_view text) {
  PhysicalSize out;
  const char* end = text.data() + text.size();
  const auto [at, failure] = std::from_chars(text.data(), end, out.width);
  if (failure != std::errc() || at == end || *at != 'x') return {};
  const auto [after, failure_too] = std::from_chars(at + 1, end, out.height);
  const bool is_sound = failure_too == std::errc() && after == end && out.width <= largest_extent &&
                        out.height <= largest_extent && out.is_known();
  return is_sound ? out : PhysicalSize();
}

void read_word(std::string_view word, FileDescription& out) {
  const size_t equals = word.find('=');
  if (equals == word.npos) {
    if (const std::optional<Semantic> semantic = semantic_of_map(std::string(word)))
      out.maps.push_back({std::string(word), *semantic});
    return;
  }
  const std::string_view key = word.substr(0, equals), value = word.substr(equals + 1);
  if (key == "green") {
    if (value == "up") out.normal_y = NormalY::up;
    if (value == "down") out.normal_y = NormalY::down;
  } else if (key == "color_space") {
    out.color_space = value;
  } else if (key == "metres") {
    out.metres = metres_in(value);
  } else if (std::optional<DescribedMap> map = packed_map(key, value)) {
    out.maps.push_back(std::move(*map));
  }
}

}  // namespace

std::optional<FileDescription> file_description(std::string_view description) {
  std::istringstream lines{std::string(description)};
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(mark)) continue;
    FileDescription out;
    std::istringstream words(line.substr(mark.size()));
    for (std::string word; words >> word;) read_word(word, out);
    if (!out.maps.empty()) return out;
  }
  return std::nullopt;
}

std::string stated_color_space(const FileInfo& file, Semantic semantic) {
  if (!is_color(semantic)) return "";
  const std::optional<FileDescription> said = file_description(file.description);
  if (!said || !is_color(said->maps.front().semantic) || said->color_space.empty()) return file.color_space;
  try {
    return canonical_color_space(said->color_space);
  } catch (const Error& e) {
    throw Error("color_space", fmt::format("the file's description says: {}. Set `color_space`", e.what()));
  }
}

std::string description_line(const FileDescription& file) {
  std::string out(mark);
  for (const DescribedMap& m : file.maps)
    out += fmt::format(" {}{}{}{}", m.name, m.channels.empty() ? "" : "=", m.inverted ? "1-" : "", m.channels);
  if (file.normal_y) out += fmt::format(" green={}", *file.normal_y == NormalY::up ? "up" : "down");
  if (!file.color_space.empty()) out += fmt::format(" color_space={}", file.color_space);
  if (file.metres.is_known()) out += fmt::format(" metres={:g}x{:g}", file.metres.width, file.metres.height);
  return out;
}

FileDescription description_of(const std::string& map, const ImageInfo& info, PhysicalSize metres) {
  FileDescription out{.maps = {{map, info.semantic}}, .color_space = info.color_space, .metres = metres};
  if (info.semantic == Semantic::normal) out.normal_y = info.normal_y;
  return out;
}

}  // namespace terrazzo
