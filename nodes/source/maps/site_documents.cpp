#include "nodes/source/maps/site_documents.h"

#include <algorithm>
#include <regex>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/text.h"
#include "core/file/file_io.h"
#include "nodes/source/maps/material_sidecar.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

using nlohmann::json;

/// "2x2", "0.5 x 0.5 m".
PhysicalSize size_in(const json& text) {
  static const std::regex form(R"(\s*([0-9]+(?:\.[0-9]+)?)\s*[x×]\s*([0-9]+(?:\.[0-9]+)?)\s*(?:m|meters|metres)?\s*)");
  std::smatch parts;
  const std::string t = text.is_string() ? text.get<std::string>() : "";
  if (!std::regex_match(t, parts, form)) return {};
  const PhysicalSize size{std::stod(parts[1]), std::stod(parts[2])};
  return size.width <= largest_extent && size.height <= largest_extent ? size : PhysicalSize();
}

PhysicalSize size_said(const json& document) {
  if (!document.is_object()) return {};
  if (const auto at = document.find("physicalSize"); at != document.end())
    if (const PhysicalSize size = size_in(*at); size.is_known()) return size;
  const auto meta = document.find("meta");
  if (meta == document.end() || !meta->is_array()) return {};
  for (const json& entry : *meta)
    if (entry.is_object() && entry.value("key", json()) == "scanArea") return size_in(entry.value("value", json()));
  return {};
}

std::string text_or_nothing(const fs::path& path) {
  try {
    return read_file(path);
  } catch (const FileError&) {
    return "";
  }
}

}  // namespace

std::vector<fs::path> site_documents(const fs::path& folder) {
  constexpr uintmax_t largest = 1 << 20;  // the known site's documents have some kilobytes
  std::vector<fs::path> files;
  std::error_code failure;
  for (const fs::directory_entry& e : fs::directory_iterator(folder, failure))
    if (lowercase(e.path().extension().string()) == ".json" && !is_sidecar(e.path()) && e.is_regular_file(failure) &&
        e.file_size(failure) <= largest)
      files.push_back(e.path());
  std::sort(files.begin(), files.end());
  return files;
}

PhysicalSize metres_in_documents(const fs::path& folder, std::vector<std::string>& notes) {
  for (const fs::path& path : site_documents(folder)) {
    const PhysicalSize size = size_said(json::parse(text_or_nothing(path), nullptr, false));
    if (!size.is_known()) continue;
    notes.push_back(fmt::format("the surface is {:g} x {:g} m, as {} says; `metres` says otherwise", size.width,
                                size.height, path.filename().string()));
    return size;
  }
  return {};
}

}  // namespace terrazzo
