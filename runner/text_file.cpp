#include "runner/text_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include <fmt/format.h>
#include <unistd.h>

#include "core/error.h"

namespace terrazzo {

namespace fs = std::filesystem;

void write_whole_file(const fs::path& path, const std::string& text) {
  const fs::path temporary = path.string() + fmt::format(".{}", ::getpid());
  std::ofstream out(temporary, std::ios::binary);
  out << text;
  out.close();
  std::error_code failure;
  if (!out) failure = std::error_code(errno, std::generic_category());
  if (!failure) fs::rename(temporary, path, failure);
  if (!failure) return;
  std::error_code ignored;
  fs::remove(temporary, ignored);
  throw Error(fmt::format("cannot write {}: {}", path.string(), failure.message()));
}

}  // namespace terrazzo
