#include "tests/image_reads.h"

#include "core/base/error.h"
#include "core/image_io/image_file.h"

namespace terrazzo::test {

ReadImage read_with_warnings(const std::filesystem::path& path, Semantic semantic) {
  ReadImage out;
  ImageInfo info;
  info.semantic = semantic;
  out.image = read_image(path, info, [&](const std::string& w) { out.warnings += w + "\n"; });
  return out;
}

std::string read_error(const std::filesystem::path& path, Semantic semantic) {
  try {
    read_with_warnings(path, semantic);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace terrazzo::test
