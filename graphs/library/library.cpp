#include "graphs/library/library.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <set>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>

#include "core/base/suggest.h"
#include "core/base/text.h"
#include "core/block_file/bytes.h"
#include "core/file/atomic_file.h"
#include "core/file/file_lock.h"
#include "core/file/user_folders.h"
#include "core/node/serialize.h"
#include "graphs/library/library_entry.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view prefix = "library:";

/// A small file as text. Throws FileError.
std::string text_of_file(const fs::path& path) {
  constexpr uint64_t most = 16 << 20;
  return read_file(path, most);
}

/// The names of all entries in a folder, without reading them.
std::vector<std::string> names_in(const fs::path& library) {
  std::vector<std::string> out;
  std::error_code failure;
  for (fs::recursive_directory_iterator at(library, fs::directory_options::skip_permission_denied, failure), end;
       !failure && at != end; at.increment(failure)) {
    if (at->path().filename().string().starts_with('.')) {
      at.disable_recursion_pending();
      continue;
    }
    std::error_code missing;
    if (at->path().extension() != ".json" || !at->is_regular_file(missing)) continue;
    out.push_back(at->path().lexically_relative(library).replace_extension().generic_string());
  }
  std::ranges::sort(out);
  return out;
}

/// Whether a name is valid, see require_library_name.
bool is_entry_name(std::string_view name) {
  bool begins = true;
  for (const char c : name) {
    if (c == '/' ? begins : !(is_word(c) || ((c == '-' || c == '.') && !begins))) return false;
    begins = c == '/';
  }
  return !begins;
}

/// The name of a file with this content beside its entry.
fs::path stored_name(const LibraryEntry& entry, const fs::path& file, const std::string& ending) {
  const std::optional<Digest> content = content_digest(file);
  if (!content) throw_system_error("read", file, errno);
  const fs::path at = entry_file(entry.library, entry.name);
  return at.parent_path() / fmt::format("{}.{}{}", at.stem().string(), content->hex().substr(0, 12), ending);
}

/// Whether stored_name could have made a file's name, for the entry with the file `entry`.
bool belongs_to(const fs::path& file, const fs::path& entry) {
  const fs::path stem = file.stem();  // red.0123456789ab
  return (file.extension() == ".analysis" || file.extension() == ".png") && stem.stem() == entry.stem() &&
         stem.extension().string().size() == 13;
}

/// Removes stale files of an entry, from replaced entries or killed processes.
void remove_files_of(const fs::path& entry, const std::vector<fs::path>& kept) {
  std::vector<fs::path> old;
  std::error_code failure;
  for (fs::directory_iterator at(entry.parent_path(), failure), end; !failure && at != end; at.increment(failure))
    if (belongs_to(at->path(), entry) && std::ranges::find(kept, at->path()) == kept.end()) old.push_back(at->path());
  for (const fs::path& file : old) fs::remove(file, failure);
}

/// While it lives, prevents other processes from changing a library: a process that replaces an entry would remove
/// files that another is just adding.
class LibraryLock {
 public:
  explicit LibraryLock(const fs::path& library) {
    constexpr std::chrono::minutes patience{1};
    std::error_code failure;
    fs::create_directories(library, failure);
    file_ = File::open(library / ".lock", O_RDWR | O_CREAT);
    if (!file_.ok()) throw_system_error("write", library / ".lock", errno);
    is_held_ = lock_file_soon(file_, LOCK_EX, patience);
    if (!is_held_ && errno == EWOULDBLOCK)
      throw Error(
          fmt::format("the library {} has been locked by another process for a minute; try again when that has "
                      "ended",
                      library.string()));
  }
  /// False if the file system has no locks.
  bool is_held() const { return is_held_; }

 private:
  File file_;
  bool is_held_ = false;
};

/// Moves a file to its place, possibly from another file system.
void bring(const fs::path& from, const fs::path& to) {
  const fs::path temporary = temporary_beside(to);
  std::error_code failure;
  fs::rename(from, temporary, failure);
  if (failure) {
    fs::copy_file(from, temporary, failure);
    if (failure) throw_system_error("write", to, failure.value());
    fs::remove(from, failure);
  }
  publish_file(temporary, to, true);
}

}  // namespace

bool is_library_reference(std::string_view text) {
  return text.starts_with(prefix);
}

void require_library_name(const std::string& name) {
  if (!is_entry_name(name))
    throw Error(
        fmt::format("\"{}\" cannot be the name of an entry; expected words of letters, digits, \"_\", \"-\" and \".\", "
                    "with \"/\" between them, such as brick/red",
                    name));
}

fs::path library_file(std::string_view reference, LibraryFile what) {
  const std::string_view asked = reference.substr(prefix.size());
  const size_t at = asked.find('@');
  const std::string name(asked.substr(0, at));
  const LibraryEntry entry = Library().find(name);
  const std::string digest(at == asked.npos ? "" : asked.substr(at + 1));
  if (at != asked.npos && (digest.empty() || !entry.content.hex().starts_with(lowercase(digest))))
    throw Error(
        fmt::format("the analysis {} has the digest {}, not one that begins with {}; it has been replaced, or the "
                    "digest is misspelt",
                    name, entry.content.hex(), digest.empty() ? "some digits" : digest));
  if (what == LibraryFile::analysis) return entry.analysis;
  if (entry.material.empty())
    throw Error(
        fmt::format("the library does not say where the maps of {} are; name their folder here, or tell the "
                    "library: terrazzo library add {} FILE --material FOLDER --force",
                    name, name));
  return entry.material;
}

std::vector<fs::path> Library::default_folders() {
  std::vector<fs::path> out;
  std::string given = environment("TERRAZZO_LIBRARY");
  for (size_t at = 0; at < given.size();) {
    const size_t end = std::min(given.find(':', at), given.size());
    if (end > at) out.push_back(fs::absolute(given.substr(at, end - at)).lexically_normal());
    at = end + 1;
  }
  if (out.empty()) out.push_back(user_folder("TERRAZZO_LIBRARY", "XDG_DATA_HOME", ".local/share") / "library");
  return out;
}

std::vector<LibraryEntry> Library::entries(std::vector<std::string>& faults) const {
  std::vector<LibraryEntry> out;
  std::set<std::string> seen;
  for (const fs::path& folder : folders_)
    for (const std::string& name : names_in(folder)) {
      if (!seen.insert(name).second) continue;
      try {
        out.push_back(entry_from_json(text_of_file(entry_file(folder, name)), name, folder));
      } catch (const Error& e) {
        faults.emplace_back(e.what());
      }
    }
  std::ranges::sort(out, {}, &LibraryEntry::name);
  return out;
}

LibraryEntry Library::find(const std::string& name) const {
  const std::optional<fs::path> library = holder_of(name);
  if (!library) throw unknown(name);
  return entry_from_json(text_of_file(entry_file(*library, name)), name, *library);
}

std::optional<fs::path> Library::holder_of(const std::string& name) const {
  require_library_name(name);
  for (const fs::path& folder : folders_) {
    std::error_code missing;
    if (fs::is_regular_file(entry_file(folder, name), missing)) return folder;
  }
  return std::nullopt;
}

Error Library::unknown(const std::string& name) const {
  std::vector<std::string> folders, names;
  for (const fs::path& folder : folders_) {
    folders.push_back(folder.string());
    for (std::string& known : names_in(folder)) names.push_back(std::move(known));
  }
  return Error(
      fmt::format("there is no analysis {} in the library {}{}", name, fmt::join(folders, " or "),
                  names.empty() ? ", which is empty; terrazzo library add makes one" : suggestion(name, names)));
}

void Library::add(LibraryEntry entry, bool replace) const {
  require_library_name(entry.name);
  entry.library = folder();
  const fs::path file = entry_file(folder(), entry.name);
  std::error_code failure;
  const LibraryLock lock(folder());
  fs::create_directories(file.parent_path(), failure);
  if (failure) throw_system_error("create", file.parent_path(), failure.value());
  if (!replace && fs::exists(file, failure))
    throw Error(fmt::format("{} has been added to the library {} meanwhile; --force replaces it", entry.name,
                            folder().string()));
  for (auto [path, ending] : {std::pair(&entry.analysis, ".analysis"), std::pair(&entry.picture, ".png")}) {
    if (path->empty()) continue;
    const fs::path place = stored_name(entry, *path, ending);
    bring(*path, place);
    *path = place;
  }
  entry.content = content_digest(entry.analysis).value_or(Digest());
  write_whole_file(file, entry_as_json(entry), temporary_beside(file), true);
  if (lock.is_held()) remove_files_of(file, {entry.analysis, entry.picture});
}

void Library::remove(const std::string& name) const {
  const std::optional<fs::path> library = holder_of(name);
  if (!library) throw unknown(name);
  std::error_code failure;
  const LibraryLock lock(*library);
  const fs::path file = entry_file(*library, name);
  if (!fs::remove(file, failure) && failure) throw_system_error("remove", file, failure.value());
  remove_files_of(file, {});
  // Also removes folders that are now empty.
  for (fs::path folder = file.parent_path(); folder != *library && fs::remove(folder, failure);)
    folder = folder.parent_path();
}

std::vector<std::string> Library::faults_of(const LibraryEntry& entry) {
  std::vector<std::string> out;
  std::error_code missing;
  const std::optional<Digest> content = content_digest(entry.analysis);
  if (!content) {
    out.push_back(fmt::format("its analysis {} cannot be read", entry.analysis.string()));
  } else if (content != entry.content) {
    out.push_back("its analysis is damaged: it does not have the digest that the entry says");
  } else {
    try {
      if (summarize_value_file(entry.analysis).type != ValueType::index) out.emplace_back("its analysis is no index");
      load_value(entry.analysis);
    } catch (const Error& e) {
      out.push_back(fmt::format("{}; add it anew", e.what()));
    }
  }
  if (!entry.picture.empty() && !fs::exists(entry.picture, missing)) out.emplace_back("its picture is missing");
  const bool is_folder = fs::is_directory(entry.material, missing);
  if (!entry.material.empty() && !is_folder && !fs::exists(entry.material, missing)) {
    out.push_back(fmt::format("what was analysed does not exist: {}", entry.material.string()));
    return out;
  }
  for (const auto& [name, digest] : entry.files) {
    const fs::path file = (is_folder ? entry.material : entry.material.parent_path()) / name;
    if (const std::optional<Digest> now = content_digest(file); now != digest)
      out.push_back(fmt::format("{} {} since it was analysed", file.string(), now ? "has changed" : "has gone"));
  }
  return out;
}

}  // namespace terrazzo
