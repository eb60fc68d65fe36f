#include "nodes/source/maps/material_sources.h"

#include <set>

#include <tbb/parallel_for.h>

#include "core/image_io/image_file.h"
#include "nodes/source/maps/turned_files.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// A file that has been read, with what the reader said.
struct Reading {
  SourcePlace place;
  Semantic semantic = Semantic::data;
  ImagePtr image{};
  std::vector<std::string> notes{};

  void read(const fs::path& folder, bool as_stored) {
    ImageInfo info;
    info.semantic = semantic;
    notes.clear();
    image = read_image(
        folder / place.first, info, [&](const std::string& w) { notes.push_back(w); }, place.second, as_stored);
  }
};

/// One for each place.
std::vector<OrientedFile> oriented_files(const fs::path& folder, const std::vector<RecognisedMap>& maps,
                                         std::vector<Reading>& readings) {
  std::vector<OrientedFile> files;
  std::set<SourcePlace> seen;
  for (const RecognisedMap& m : maps) {
    const SourcePlace place = place_of(m);
    if (!seen.insert(place).second) {
      for (size_t i = 0; i < readings.size(); i++)
        if (readings[i].place == place && m.interpretation.as_stored) files[i].asked = m.interpretation.as_stored;
      continue;
    }
    try {
      files.push_back({.name = m.file,
                       .map = m.map,
                       .info = read_image_info(folder / m.file, m.layer),
                       .asked = m.interpretation.as_stored});
    } catch (const Error&) {
      files.push_back({.name = m.file, .map = m.map, .info = {}});  // reading reports the error
    }
    readings.push_back({place, m.semantic});
  }
  return files;
}

}  // namespace

Sources read_sources(NodeContext& node, const fs::path& folder, const std::vector<RecognisedMap>& maps) {
  std::vector<Reading> readings;
  std::vector<OrientedFile> files = oriented_files(folder, maps, readings);
  std::vector<std::string> notes;
  settle_orientations_by_shape(files, notes);
  tbb::parallel_for(size_t{0}, readings.size(), [&](size_t i) {
    const CurrentTask working(node.task());
    readings[i].read(folder, files[i].as_stored);
  });
  std::vector<ImagePtr> pictures;
  for (const Reading& r : readings) pictures.push_back(r.image);
  std::vector<Reading> again = readings;
  const auto read_as_stored = [&](size_t i) {
    node.task().check();
    again[i].read(folder, true);
    return again[i].image;
  };
  settle_orientations_by_pixels(files, pictures, read_as_stored, notes);
  Sources sources;
  std::set<std::string> said;  // notes about all layers of a file appear once
  for (size_t i = 0; i < readings.size(); i++) {
    const bool is_again = pictures[i] != readings[i].image;
    sources[readings[i].place] = {pictures[i], files[i].info.channel_names};
    for (const std::string& n : (is_again ? again : readings)[i].notes)
      if (said.insert(n).second) node.note(n);
  }
  for (std::string& n : notes) node.note(std::move(n));
  return sources;
}

std::map<SourcePlace, Size> sizes_of_sources(const fs::path& folder, const std::vector<RecognisedMap>& maps) {
  std::vector<Reading> readings;
  std::vector<OrientedFile> files = oriented_files(folder, maps, readings);
  std::vector<std::string> notes;
  settle_orientations_by_shape(files, notes);
  std::map<SourcePlace, Size> sizes;
  for (size_t i = 0; i < files.size(); i++)
    if (files[i].info.channels > 0) sizes.emplace(readings[i].place, files[i].size());
  return sizes;
}

}  // namespace terrazzo
