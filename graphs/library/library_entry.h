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
  std::filesystem::path library;        ///< the folder it lies in
  std::filesystem::path analysis;       ///< the file that load_analysis reads
  Digest content;                       ///< of that file
  std::filesystem::path picture;        ///< empty if there is none
  std::filesystem::path material;       ///< the folder of the analysed maps; empty if it is not known
  std::map<std::string, Digest> files;  ///< the content of the maps' files, by name, when they were analysed
  std::map<std::string, int> versions;  ///< of the node types that made the analysis
  std::vector<std::string> settings;    ///< with which the maps were analysed, as for --set
  std::vector<std::string> maps;        ///< that were analysed
  Size size;                            ///< of the exemplar
  std::string added;                    ///< the day, "2026-11-25"
};

/// An entry as the JSON file that describes it. Files beside it go by name; the material's folder is relative to the
/// library if it lies in it.
std::string entry_as_json(const LibraryEntry& entry);

/// The way back. `text`: of the file of the entry `name` in `library`. Throws Error that says what is wrong with it.
LibraryEntry entry_from_json(std::string_view text, const std::string& name, const std::filesystem::path& library);

/// The file that describes an entry.
std::filesystem::path entry_file(const std::filesystem::path& library, const std::string& name);

}  // namespace terrazzo
