#include "nodes/source/maps/given_maps.h"

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/image_io/image_file.h"
#include "core/material/map_names.h"
#include "core/material/material_maps.h"
#include "core/naming/file_stems.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

bool are_channels(std::string_view text) {
  return text.find_first_not_of("rgba") == std::string_view::npos;
}

std::string with_tile(std::string text, const Params& params) {
  constexpr std::string_view token = "<UDIM>";
  for (size_t at; (at = text.find(token)) != std::string::npos;) {
    const std::string& name = std::get<std::string>(params.at("name"));
    const std::string tile = udim_tile_of(name);
    if (tile.empty())
      throw Error(
          fmt::format("<UDIM> stands for the tile that `name` picks, such as \"wall.1002\"; `name` is \"{}\"", name));
    text.replace(at, token.size(), tile);
  }
  return text;
}

void require_given_map(const Params& params, const fs::path& folder, const std::string& map, const std::string& text) {
  const RecognisedMap given = given_map(params, map, text);
  const size_t colon = given.file.rfind(':');
  std::error_code missing;
  if (colon != std::string::npos && !fs::exists(folder / given.file, missing) &&
      fs::is_regular_file(folder / given.file.substr(0, colon), missing))
    throw Error(fmt::format("{} should be channel {} of {}, but channels are called r, g, b and a", map,
                            given.file.substr(colon + 1), given.file.substr(0, colon)));
  require_image_file(folder / given.file);
  if (!given.channels.empty() || !given.layer.empty())
    require_channels(given, read_image_info(folder / given.file, given.layer).channels);
}

}  // namespace

RecognisedMap given_map(const Params& params, const std::string& map, const std::string& text) {
  RecognisedMap m{.map = map, .semantic = *semantic_of_map(map), .file = with_tile(text, params), .channels = ""};
  const size_t colon = m.file.rfind(':');
  if (colon == std::string::npos) return m;
  const std::string file = m.file.substr(0, colon), place = m.file.substr(colon + 1);
  if (are_channels(place)) {
    m.channels = place;
  } else if (lowercase(fs::path(file).extension().string()) == ".exr") {
    const size_t dot = place.rfind('.');
    const bool has_channels = dot != std::string::npos && are_channels(std::string_view(place).substr(dot + 1));
    m.layer = place.substr(0, has_channels ? dot : place.size());
    if (has_channels) m.channels = place.substr(dot + 1);
  } else {
    return m;
  }
  m.file = file;
  return m;
}

void require_given_maps(const Params& params, const fs::path& folder) {
  std::vector<Error> troubles;
  for (const auto& [map, text] : std::get<TextMap>(params.at("maps"))) try {
      if (!text.empty()) require_given_map(params, folder, map, text);
    } catch (const Error& e) {
      troubles.emplace_back("maps." + map, e.what());
    }
  if (!troubles.empty()) throw Errors(std::move(troubles));
}

}  // namespace terrazzo
