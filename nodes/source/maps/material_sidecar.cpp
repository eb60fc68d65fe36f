#include "nodes/source/maps/material_sidecar.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/suggest.h"
#include "core/file/file_io.h"
#include "core/image_io/color.h"
#include "core/material/map_names.h"
#include "core/naming/file_stems.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int known_format = 1;
constexpr std::string_view first_of_name = "terrazzo-material", last_of_name = ".json";

/// A value and its place for messages: `"files": "orm.png"`.
struct Entry {
  const Json& value;
  std::string where;

  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(where.empty() ? reason : fmt::format("{}: {}", where, reason));
  }
  Entry inside(const std::string& key, const Json& member) const {
    return {member, fmt::format("{}{}\"{}\"", where, where.empty() ? "" : ": ", key)};
  }
  std::optional<Entry> find(const std::string& key) const {
    const auto member = value.find(key);
    if (member == value.end()) return std::nullopt;
    return inside(key, *member);
  }
  const Entry& require(bool right_type, const char* expected) const {
    if (!right_type) fail(fmt::format("expected {}, found {}", expected, value.dump()));
    return *this;
  }
  std::string text(const char* expected = "a text") const {
    require(value.is_string(), expected);
    return value.get<std::string>();
  }
};

NormalY direction_in(const Entry& entry) {
  const std::string text = entry.text("\"up\" or \"down\"");
  if (text != "up" && text != "down") entry.fail(fmt::format("expected \"up\" or \"down\", found \"{}\"", text));
  return text == "up" ? NormalY::up : NormalY::down;
}

std::string color_space_in(const Entry& entry) {
  try {
    return canonical_color_space(entry.text("the name of a colour space"));
  } catch (const Error& e) {
    entry.fail(e.what());
  }
}

RecognisedMap map_in(const Entry& entry, const std::string& map, const std::string& file) {
  const std::optional<Semantic> semantic = semantic_of_map(map);
  if (!semantic) {
    const std::vector<std::string> known(semantic_names.begin(), semantic_names.end());
    entry.fail(fmt::format("there is no map of that name{}; maps are {}, or one of these with a suffix as in mask_moss",
                           did_you_mean(map, known), fmt::join(known, ", ")));
  }
  const std::string channels = entry.text("channels such as \"rgb\" or \"g\"");
  if (channels.empty() || channels.size() > 4 || channels.find_first_not_of("rgba") != std::string::npos)
    entry.fail(fmt::format("expected channels such as \"rgb\" or \"g\", found \"{}\"", channels));
  return {.map = map, .semantic = *semantic, .file = file, .channels = channels, .said_by = sidecar_name()};
}

void invert(const Entry& entry, std::vector<RecognisedMap>& maps) {
  entry.require(entry.value.is_array(), "a list of maps");
  for (const Json& item : entry.value) {
    const std::string name = Entry{item, entry.where}.text("a list of maps");
    const auto map = std::find_if(maps.begin(), maps.end(), [&](const RecognisedMap& m) { return m.map == name; });
    if (map == maps.end()) entry.fail(fmt::format("\"{}\" is none of the maps of this file", name));
    map->inverted = true;
  }
}

void read_file_entry(const Entry& entry, const std::string& file, const fs::path& folder, Sidecar& out) {
  entry.require(entry.value.is_object(), "an object with \"maps\"");
  if (fs::path(file).filename() != file || file == ".." || file == ".")
    entry.fail("expected the name of a file in the folder");
  std::error_code failure;
  if (!fs::exists(folder / file, failure))
    entry.fail("the folder has no such file; put it back, or take it out of " + sidecar_name());
  const std::optional<Entry> listed = entry.find("maps");
  if (!listed || !listed->value.is_object()) entry.fail("expected \"maps\" with the channels of each map");
  std::vector<RecognisedMap> maps;
  for (const auto& [map, channels] : listed->value.items())
    maps.push_back(map_in(listed->inside(map, channels), map, file));
  if (const auto inverted = entry.find("inverted")) invert(*inverted, maps);
  if (const auto how = entry.find("interpret")) {
    const std::string words = how->text("words such as \"dxt5nm\" or \"depth\"");
    for (RecognisedMap& m : maps) try {
        m.interpretation = interpretation_from(words, m.semantic);
        m.inverted = m.interpretation.inverted.value_or(m.inverted);
      } catch (const Error& e) {
        how->fail(e.what());
      }
  }
  if (const auto green = entry.find("normal_y")) {
    const NormalY direction = direction_in(*green);
    for (RecognisedMap& m : maps)
      if (m.semantic == Semantic::normal) m.normal_y = direction;
  }
  if (const auto space = entry.find("color_space")) {
    const std::string name = color_space_in(*space);
    for (RecognisedMap& m : maps) m.color_space = name;
  }
  out.files.push_back(file);
  out.maps.insert(out.maps.end(), maps.begin(), maps.end());
}

PhysicalSize metres_in(const Entry& entry) {
  const Json& v = entry.value;
  const bool are_two = v.is_array() && v.size() == 2 && v[0].is_number() && v[1].is_number() && v[0] > 0 && v[1] > 0;
  entry.require(are_two, "two numbers above 0, width and height");
  return {v[0].get<double>(), v[1].get<double>()};
}

Sidecar parsed(const Json& json, const fs::path& folder) {
  const Entry all{json, ""};
  all.require(json.is_object(), "an object");
  const std::optional<Entry> format = all.find("terrazzo_material");
  if (!format || !format->value.is_number_integer())
    all.fail(fmt::format("expected \"terrazzo_material\": {}, the version of its format", known_format));
  if (format->value != known_format)
    format->fail(
        fmt::format("format {} is not known, this program reads {}; it was written by another version of "
                    "terrazzo",
                    format->value.dump(), known_format));
  Sidecar out;
  if (const auto name = all.find("name")) out.name = name->text();
  if (const auto metres = all.find("metres"); metres && !metres->value.is_null()) out.metres = metres_in(*metres);
  const std::optional<Entry> files = all.find("files");
  if (!files || !files->value.is_object()) all.fail("expected \"files\" with an object for each file");
  if (files->value.empty())
    files->fail(
        "none is named: the last export wrote its maps into one binary file only. To read the images in the folder "
        "by their names, remove " +
        sidecar_name(out.name));
  for (const auto& [file, entry] : files->value.items()) read_file_entry(files->inside(file, entry), file, folder, out);
  if (out.maps.empty()) files->fail("none of the files has a map");
  return out;
}

std::string text_of(const fs::path& path) {
  constexpr uint64_t most = 64 << 20;
  return read_file(path, most);
}

/// The message of nlohmann-json without its error number.
std::string reason_of(const nlohmann::json::exception& e) {
  const std::string text = e.what();
  const size_t end = text.find("] ");
  return end == std::string::npos ? text : text.substr(end + 2);
}

}  // namespace

std::vector<std::string> files_exported_before(const fs::path& folder, const std::string& material) {
  const fs::path path = folder / sidecar_name(material);
  std::error_code failure;
  if (!fs::is_regular_file(path, failure)) return {};
  std::vector<std::string> out;
  try {
    const Json json = Json::parse(text_of(path));
    if (!json.contains("preset") || json.at("name") != material) return {};
    for (const auto& [name, entry] : json.at("files").items())
      if (fs::path(name).filename() == name) out.push_back(name);
  } catch (const nlohmann::json::exception&) {
    return {};
  } catch (const Error&) {
    return {};
  }
  return out;
}

std::string sidecar_name(std::string_view material) {
  const std::string tile = udim_tile_of(material);
  return std::string(first_of_name) + (tile.empty() ? "" : "." + tile) + std::string(last_of_name);
}

bool is_sidecar(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with(first_of_name) && name.ends_with(last_of_name);
}

std::optional<Sidecar> read_sidecar(const fs::path& folder, std::string_view material) {
  const fs::path path = folder / sidecar_name(material);
  std::error_code failure;
  if (!fs::exists(path, failure)) return std::nullopt;
  try {
    return parsed(Json::parse(text_of(path)), folder);
  } catch (const nlohmann::json::exception& e) {
    throw Error("path", fmt::format("{}: it is no JSON: {}", path.string(), reason_of(e)));
  } catch (const Error& e) {
    throw Error("path", fmt::format("{}: {}", path.string(), e.what()));
  }
}

}  // namespace terrazzo
