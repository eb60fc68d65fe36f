#include "graphs/library/library_entry.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr int format = 1;

/// Relative if it is inside the library, whose path may differ between machines.
std::string seen_from(const fs::path& library, const fs::path& path) {
  const fs::path inside = path.lexically_relative(library);
  return (inside.empty() || *inside.begin() == ".." ? path : inside).generic_string();
}

/// The name of a file beside the entry's own; nothing else may be named there.
fs::path beside(const fs::path& entry, const std::string& name) {
  if (name.empty()) return {};
  if (fs::path(name).filename() != name || name == "..")
    throw Error(fmt::format("expected the name of a file beside it, found \"{}\"", name));
  return entry.parent_path() / name;
}

Digest digest_in(const std::string& text) {
  Digest out;
  if (!Digest::parse(text, out)) throw Error(fmt::format("expected a digest of 32 digits, found \"{}\"", text));
  return out;
}

}  // namespace

fs::path entry_file(const fs::path& library, const std::string& name) {
  return library / (name + ".json");
}

std::string entry_as_json(const LibraryEntry& entry) {
  ordered_json files = ordered_json::object();
  for (const auto& [name, digest] : entry.files) files[name] = digest.hex();
  const ordered_json json = {
      {"terrazzo_library", format},
      {"summary", entry.summary},
      {"tags", entry.tags},
      {"analysis", entry.analysis.filename().string()},
      {"content", entry.content.hex()},
      {"picture", entry.picture.filename().string()},
      {"size", {entry.size.width, entry.size.height}},
      {"maps", entry.maps},
      {"material", entry.material.empty() ? "" : seen_from(entry.library, entry.material)},
      {"files", files},
      {"settings", entry.settings},
      {"versions", entry.versions},
      {"added", entry.added},
  };
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

LibraryEntry entry_from_json(std::string_view text, const std::string& name, const fs::path& library) {
  const fs::path file = entry_file(library, name);
  try {
    const ordered_json json = ordered_json::parse(text);
    if (const int found = json.at("terrazzo_library"); found != format)
      throw Error(fmt::format("its format version is {}, and this terrazzo reads version {}", found, format));
    LibraryEntry e;
    e.name = name;
    e.library = library;
    e.summary = json.at("summary");
    e.tags = json.at("tags");
    e.analysis = beside(file, json.at("analysis"));
    e.content = digest_in(json.at("content"));
    e.picture = beside(file, json.at("picture"));
    e.size = {json.at("size").at(0), json.at("size").at(1)};
    e.maps = json.at("maps");
    const std::string material = json.at("material");
    if (!material.empty()) e.material = library / material;
    for (const auto& [map, digest] : json.at("files").items()) e.files[map] = digest_in(digest);
    e.settings = json.at("settings");
    e.versions = json.at("versions");
    e.added = json.at("added");
    if (e.analysis.empty()) throw Error("it names no analysis");
    return e;
  } catch (const ordered_json::exception& e) {
    throw Error(fmt::format("{} is not an entry of a library: {}", file.string(), e.what()));
  } catch (const Error& e) {
    throw Error(fmt::format("{} cannot be used: {}", file.string(), e.what()));
  }
}

}  // namespace terrazzo
