#include "nodes/source/maps/unnamed_packings.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/image_io/image_file.h"
#include "core/material/material_maps.h"
#include "core/naming/packing_guess.h"

namespace terrazzo {

namespace {

void add(const std::string& file, const ImagePtr& image, const PackingGuess& guess, std::vector<Map>& maps,
         std::vector<std::string>& notes) {
  std::string places;
  for (const GuessedMap& g : guess.maps) {
    const std::string name(name_of(g.semantic));
    const RecognisedMap source{.map = name,
                               .semantic = g.semantic,
                               .file = file,
                               .channels = std::string(1, g.channel),
                               .inverted = g.inverted};
    maps.push_back({name, map_of_file(source, image, "raw", notes)});
    places += fmt::format("{}{} {}{}", places.empty() ? "" : ", ", g.channel, name, g.inverted ? " (inverted)" : "");
  }
  notes.push_back(
      fmt::format("{}: its name says no map; it is taken for {}. So: {}. `ignore` leaves it out, `maps` says "
                  "what it is",
                  file, guess.grounds, places));
}

}  // namespace

void add_unnamed_packing(const std::filesystem::path& folder, const std::vector<std::string>& unnamed,
                         std::vector<Map>& maps, std::vector<std::string>& ignored, std::vector<std::string>& notes) {
  const auto is_packed = [](const Map& m) {
    return std::ranges::find(packed_semantics, m.image->info().semantic) != packed_semantics.end();
  };
  if (std::ranges::any_of(maps, is_packed)) return;
  const auto height = std::ranges::find(maps, "height", &Map::name);
  for (const std::string& file : unnamed) {
    const ImagePtr image = read_image(folder / file, {}, [](const std::string&) {});
    const PackingGuess guess = guess_packing(image, height == maps.end() ? nullptr : height->image);
    if (guess.maps.empty()) continue;
    add(file, image, guess, maps, notes);
    std::erase(ignored, file);
    return;
  }
}

}  // namespace terrazzo
