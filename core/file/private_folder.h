#pragma once

#include <filesystem>
#include <string>

namespace terrazzo {

/// A temporary folder of this process, readable only by the user, with a name from `temporary_beside`. The destructor
/// removes it with its content.
class PrivateFolder {
 public:
  /// Creates it in `parent`, which is created if missing. `stem`: a readable part of the name. Throws FileError.
  PrivateFolder(const std::filesystem::path& parent, const std::string& stem);
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace terrazzo
