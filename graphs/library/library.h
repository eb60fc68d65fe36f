#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/node/node.h"
#include "graphs/library/library_entry.h"

/// Named analyses that graphs and people share: `"library:brick/red"` in a graph stands for one of them. A library is a
/// folder. Of the entry brick/red it holds brick/red.json, which describes it and names the files beside it: the
/// analysis and a picture, whose names carry their content's digest. So an entry is replaced in one step, while others
/// read it. Thread-safe; several processes may use one library at once.
namespace terrazzo {

/// Whether a text names an entry of a library.
bool is_library_reference(std::string_view text);

/// The file or folder that "library:NAME" stands for, and "library:NAME@DIGEST", which insists on an analysis whose
/// digest begins like that. `what`: analysis or material. Throws Error.
std::filesystem::path library_file(std::string_view reference, LibraryFile what);

/// Folders that belong together: an entry of the first hides those of the same name in others. New ones go into the
/// first.
class Library {
 public:
  /// The folders of $TERRAZZO_LIBRARY, separated by colons, or terrazzo/library under $XDG_DATA_HOME or ~/.local/share.
  static std::vector<std::filesystem::path> default_folders();
  explicit Library(std::vector<std::filesystem::path> folders = default_folders()) : folders_(std::move(folders)) {}

  const std::filesystem::path& folder() const { return folders_.front(); }

  /// Of one that cannot be read, `faults` says why.
  std::vector<LibraryEntry> entries(std::vector<std::string>& faults) const;
  /// Throws Error if there is no such entry, or it cannot be read.
  LibraryEntry find(const std::string& name) const;
  bool contains(const std::string& name) const { return holder_of(name).has_value(); }

  /// Moves the files that `entry` names into the library and writes the entry, in place of one of its name only if
  /// `replace`. Of several at once, one comes after the other. Throws Error.
  void add(LibraryEntry entry, bool replace) const;
  /// Removes an entry, whether it can be read or not, with its files. Throws Error.
  void remove(const std::string& name) const;

  /// What is wrong with an entry's files: damaged, changed or missing.
  static std::vector<std::string> faults_of(const LibraryEntry& entry);

 private:
  /// The first folder that has an entry of that name.
  std::optional<std::filesystem::path> holder_of(const std::string& name) const;
  Error unknown(const std::string& name) const;
  std::vector<std::filesystem::path> folders_;
};

/// Throws Error unless it can be an entry's name: words of letters, digits, "_", "-" and ".", with "/" between them.
void require_library_name(const std::string& name);

}  // namespace terrazzo
