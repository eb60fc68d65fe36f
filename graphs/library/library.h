#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/node/node.h"
#include "graphs/library/library_entry.h"

/// Named analyses shared between graphs and users: a graph refers to one as `"library:brick/red"`. A library is a
/// folder. For the entry brick/red it holds brick/red.json, which describes the entry and names two files beside it,
/// the analysis and a picture. Their names contain the digest of their content, so an entry can be replaced atomically
/// while others read it. Thread-safe, and safe for several processes.
namespace terrazzo {

/// Whether a text names an entry of a library.
bool is_library_reference(std::string_view text);

/// The file or folder that "library:NAME" refers to. "library:NAME@DIGEST" requires that the analysis's digest begins
/// with DIGEST. `what`: analysis or material. Throws Error.
std::filesystem::path library_file(std::string_view reference, LibraryFile what);

/// A search path of folders. Entries of earlier folders hide entries of the same name in later ones. New entries go
/// into the first folder.
class Library {
 public:
  /// The folders of $TERRAZZO_LIBRARY, separated by colons, or terrazzo/library under $XDG_DATA_HOME or ~/.local/share.
  static std::vector<std::filesystem::path> default_folders();
  explicit Library(std::vector<std::filesystem::path> folders = default_folders()) : folders_(std::move(folders)) {}

  const std::filesystem::path& folder() const { return folders_.front(); }

  /// All readable entries. Adds a message to `faults` for each unreadable one.
  std::vector<LibraryEntry> entries(std::vector<std::string>& faults) const;
  /// Throws Error if the entry does not exist or cannot be read.
  LibraryEntry find(const std::string& name) const;
  bool contains(const std::string& name) const { return holder_of(name).has_value(); }

  /// Moves the files that `entry` names into the library and writes the entry. Overwrites an entry of the same name
  /// only if `replace`. Concurrent calls are serialised. Throws Error.
  void add(LibraryEntry entry, bool replace) const;
  /// Removes an entry with its files, even if it is unreadable. Throws Error.
  void remove(const std::string& name) const;

  /// Messages about an entry's damaged, changed or missing files.
  static std::vector<std::string> faults_of(const LibraryEntry& entry);

 private:
  /// The first folder that has an entry of that name.
  std::optional<std::filesystem::path> holder_of(const std::string& name) const;
  Error unknown(const std::string& name) const;
  std::vector<std::filesystem::path> folders_;
};

/// Throws Error unless `name` is a valid entry name: words of letters, digits, "_", "-" and ".", with "/" between them.
void require_library_name(const std::string& name);

}  // namespace terrazzo
