#pragma once

#include <filesystem>
#include <string>

namespace terrazzo {

/// A folder for this process alone, with a name of `temporary_beside`; it and all in it go with this object. Only the
/// user may look into it.
class PrivateFolder {
 public:
  /// Makes it in `parent`, and `parent` if that is missing. `stem` is for people. Throws FileError if it cannot.
  PrivateFolder(const std::filesystem::path& parent, const std::string& stem);
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace terrazzo
