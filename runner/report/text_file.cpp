#include "runner/report/text_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/file/atomic_file.h"

namespace terrazzo {

namespace fs = std::filesystem;

void write_whole_file(const fs::path& path, const std::string& text) {
  std::error_code missing;
  const bool is_device = fs::exists(path, missing) && !fs::is_regular_file(path, missing);
  const fs::path temporary = is_device ? path : temporary_beside(path);
  std::ofstream out(temporary, std::ios::binary);
  out << text;
  out.close();
  std::error_code failure;
  if (!out) failure = std::error_code(errno, std::generic_category());
  if (!failure && !is_device) fs::rename(temporary, path, failure);
  if (!failure) return;
  std::error_code ignored;
  if (!is_device) fs::remove(temporary, ignored);
  throw Error(fmt::format("cannot write {}: {}", path.string(), failure.message()));
}

}  // namespace terrazzo
