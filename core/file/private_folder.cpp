#include "core/file/private_folder.h"

#include <cerrno>

#include <sys/stat.h>

#include "core/file/atomic_file.h"
#include "core/file/file_io.h"

namespace terrazzo {

namespace fs = std::filesystem;

PrivateFolder::PrivateFolder(const fs::path& parent, const std::string& stem) {
  std::error_code failure;
  fs::create_directories(parent, failure);
  if (failure) throw_system_error("create", parent, failure.value());
  path_ = temporary_beside(parent / stem);
  if (::mkdir(path_.c_str(), S_IRWXU) != 0) throw_system_error("create", path_, errno);
}

PrivateFolder::~PrivateFolder() {
  std::error_code failure;
  fs::remove_all(path_, failure);
}

}  // namespace terrazzo
