#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/image/image_ops.h"
#include "core/image/normal.h"
#include "core/image_io/color.h"
#include "nodes/exchange/export_preset.h"

namespace terrazzo {

namespace {

using Channel = FileContent::Channel;

/// A map converted for files: normals in the preset's convention, colours in sRGB.
ImagePtr conventional(const ImagePtr& map, NormalY wanted) {
  return is_color(map->info().semantic) ? convert_color(map, "srgb_texture") : with_normal_y(map, wanted);
}

/// 8 bits are too few for maps that are filtered or used for displacement: steps become visible.
Depth depth_of(const ImageInfo& info) {
  return info.semantic == Semantic::height ? std::max(info.depth, Depth::u16) : info.depth;
}

/// The maps of a material by name, converted for files.
class PresetSources {
 public:
  PresetSources(const Material& material, NormalY normal_y) {
    for (const Map& m : material.maps()) maps_.push_back({m.name, conventional(m.image, normal_y)});
  }
  ImagePtr find(std::string_view name) const {
    const auto at = std::ranges::find(maps_, name, &Map::name);
    return at == maps_.end() ? nullptr : at->image;
  }

 private:
  std::vector<Map> maps_;
};

/// The channels of a file for the maps that exist.
std::vector<Channel> channels_for(const PresetFile& file, const PresetSources& sources) {
  std::vector<Channel> out;
  for (const ChannelSource& s : file.channels) {
    const ImagePtr map = s.map.empty() ? nullptr : sources.find(s.map);
    // One-channel colours and normals are repeated in all three channels.
    if (map)
      out.push_back({std::string(s.map), std::min(s.channel, map->channels() - 1), s.inverted, 0});
    else
      out.push_back({"", 0, false, s.inverted ? 1 - s.otherwise : s.otherwise});
  }
  // Without opacity colours have no alpha.
  if (file.channels.back().map == "opacity" && out.back().map.empty()) out.pop_back();
  return out;
}

ImagePtr packed(const std::vector<Channel>& channels, const PresetSources& sources) {
  std::vector<ImagePtr> maps;
  Size largest;
  ImageInfo info;
  for (const Channel& c : channels) {
    const ImagePtr map = c.map.empty() ? nullptr : sources.find(c.map);
    maps.push_back(map);
    if (!map) continue;
    if (largest.area() == 0) info = map->info();
    if (map->size().area() > largest.area()) largest = map->size();
    info.depth = std::max(info.depth, depth_of(map->info()));
  }
  info.size = largest;
  const bool is_one_map = std::ranges::all_of(channels, [&](const Channel& c) { return c.map == channels[0].map; });
  const bool is_colour = is_color(info.semantic);
  info.channels = int(channels.size());
  if (!is_one_map && !is_colour) {
    info.semantic = Semantic::data;
    info.color_space = "raw";
  }
  Hasher recipe;
  recipe.add("packed").add(int64_t(channels.size()));
  std::vector<ImagePtr> inputs;
  std::vector<int> input_of;
  for (size_t i = 0; i < channels.size(); i++) {
    recipe.add(channels[i].channel).add(channels[i].inverted).add(channels[i].constant).add(bool(maps[i]));
    input_of.push_back(maps[i] ? int(inputs.size()) : -1);
    if (!maps[i]) continue;
    recipe.add(maps[i]->digest());
    inputs.push_back(nearest_at_size(maps[i], largest));
  }
  return pixel_by_pixel(info, recipe.digest(), inputs, [=](auto in, float* out, int64_t count) {
    const size_t n = channels.size();
    for (size_t c = 0; c < n; c++) {
      if (input_of[c] < 0) {
        for (int64_t i = 0; i < count; i++) out[i * int64_t(n) + int64_t(c)] = float(channels[c].constant);
        continue;
      }
      const float* pixels = in[size_t(input_of[c])] + channels[c].channel;
      const int step = maps[c]->channels();
      for (int64_t i = 0; i < count; i++) {
        const float v = pixels[i * step];
        out[i * int64_t(n) + int64_t(c)] = channels[c].inverted ? 1.0f - v : v;
      }
    }
  });
}

FileContent whole_file(const std::string& name, const Map& map, NormalY normal_y) {
  FileContent out{.name = name, .image = conventional(map.image, normal_y), .channels = {}};
  ImageInfo info = out.image->info();
  info.depth = depth_of(info);
  out.image = Image::redescribed(out.image, info);
  for (int c = 0; c < info.channels; c++) out.channels.push_back({map.name, c, false, 0});
  return out;
}

void note_constants(const FileContent& file, const PresetFile& made_by, std::vector<std::string>& notes) {
  for (size_t i = 0; i < file.channels.size(); i++)
    if (file.channels[i].map.empty() && !made_by.channels[i].map.empty())
      notes.push_back(fmt::format("{}: the material has no {}, so channel {} is {:g} everywhere", file.name,
                                  made_by.channels[i].map, "rgba"[i], file.channels[i].constant));
}

}  // namespace

std::string FileContent::whole_map() const {
  for (const Channel& c : channels)
    if (c.map.empty() || c.map != channels.front().map) return "";
  return channels.front().map;
}

const FileContent::Channel* FileContent::find(std::string_view map) const {
  const auto at = std::ranges::find(channels, map, &Channel::map);
  return at == channels.end() ? nullptr : &*at;
}

std::vector<FileContent> preset_files(const ExportPreset& preset, const Material& material, const std::string& name,
                                      std::vector<std::string>& notes) {
  const PresetSources sources(material, preset.normal_y);
  const std::string prefix = preset.name == "unreal" ? "T_" + name : name;
  std::vector<FileContent> out;
  std::set<std::string> taken;
  for (const PresetFile& file : preset.files) {
    if (std::ranges::none_of(file.needs, [&](std::string_view map) { return sources.find(map) != nullptr; })) continue;
    FileContent content{
        .name = prefix + std::string(file.suffix), .image = nullptr, .channels = channels_for(file, sources)};
    content.image = packed(content.channels, sources);
    for (const Channel& c : content.channels) taken.insert(c.map);
    note_constants(content, file, notes);
    out.push_back(std::move(content));
  }
  for (const Map& m : material.maps()) {
    if (taken.contains(m.name)) continue;
    out.push_back(whole_file(prefix + "_" + m.name, m, preset.normal_y));
    if (!preset.files.empty())
      notes.push_back(
          fmt::format("{}: no file of {} has a place for it; it is written as a separate file", m.name, preset.name));
  }
  return out;
}

}  // namespace terrazzo
