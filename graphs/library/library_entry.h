#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/hash.h"

namespace terrazzo {

/// A named analysis in a library, see graphs/library/library.h.
struct LibraryEntry {
  std::string name;  ///< "brick/red"
  std::string summary;
  std::vector<std::string> tags;
  std::filesystem::path library;        ///< the folder that contains it
  std::filesystem::path analysis;       ///< the file that load_analysis reads
  Digest content;                       ///< of that file
  std::filesystem::path picture;        ///< empty if there is none
  std::filesystem::path material;       ///< the folder of the analysed maps, or the picture; empty if unknown
  std::map<std::string, Digest> files;  ///< digests of the files at the time of analysis, by name
  std::map<std::string, int> versions;  ///< of the node types that made the analysis
  std::vector<std::string> settings;    ///< settings of the analysis, as for --set
  std::vector<std::string> maps;        ///< the analysed maps
  Size size;                            ///< of the exemplar
  std::string added;                    ///< date, "2026-11-25"
};

/// Formats an entry as its JSON file. Files beside it are given by name; the material's folder is relative if it lies
/// inside the library.
std::string entry_as_json(const LibraryEntry& entry);

/// The inverse. `text`: the content of the file of entry `name` in `library`. Throws Error if it is invalid.
LibraryEntry entry_from_json(std::string_view text, const std::string& name, const std::filesystem::path& library);

/// The file that describes an entry.
std::filesystem::path entry_file(const std::filesystem::path& library, const std::string& name);

}  // namespace terrazzo
