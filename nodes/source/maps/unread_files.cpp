#include "nodes/source/maps/unread_files.h"

#include <algorithm>
#include <set>
#include <system_error>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/image_io/image_file.h"
#include "core/material/recognised_map.h"
#include "core/naming/file_words.h"

namespace terrazzo {

namespace fs = std::filesystem;

bool is_no_folder(const fs::directory_entry& entry) {
  std::error_code failure;
  return !entry.is_directory(failure);
}

std::vector<std::string> notes_on_other_formats(const fs::path& folder) {
  static const std::set<std::string> unread = {"kra",   "xcf",  "psb", "svg", "clip", "ktx",  "ktx2",
                                               "basis", "astc", "vtf", "jxl", "heic", "heif", "avif",
                                               "dng",   "cr2",  "cr3", "nef", "arw"};
  std::vector<std::string> notes;
  std::error_code failure;
  for (const fs::directory_entry& e : fs::directory_iterator(folder, failure)) {
    const std::string name = e.path().filename().string();
    const std::string ending = extension_of(name);
    if (!is_no_folder(e) || name[0] == '.' || !unread.count(ending)) continue;
    const std::vector<RecognisedMap> maps = recognise_map({.name = name, .size = {}});
    if (maps.empty() || !reason_to_skip(name).empty()) continue;
    notes.push_back(fmt::format("{}{} is left out: .{} is not read. If it is to be {}, save it as PNG, TIFF or EXR",
                                warning_mark, name, ending, maps.front().map));
  }
  std::sort(notes.begin(), notes.end());
  return notes;
}

std::string maps_of_other_endings(const std::vector<std::string>& present) {
  std::string out;
  for (const std::string& name : present) {
    const bool is_file = !name.ends_with('/') && !looks_like_image(name);
    if (!is_file || extension_of(name).empty() || recognise_map({.name = name, .size = {}}).empty()) continue;
    out +=
        fmt::format("; {} would be a map by its name, but .{} files are not read as images", name, extension_of(name));
  }
  return out;
}

}  // namespace terrazzo
