#include "core/file/module_path.h"

#include <array>

#include <dlfcn.h>
#include <fmt/format.h>

#include "core/base/error.h"
#include "module_folder.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

/// The folder of the library that this code is in.
fs::path own_folder() {
  std::error_code unreadable;
  Dl_info place{};
  const bool is_known = ::dladdr(reinterpret_cast<const void*>(&module_path), &place) != 0;
  return fs::canonical(is_known ? place.dli_fname : "/proc/self/exe", unreadable).parent_path();
}

}  // namespace

fs::path module_path(const std::string& name, const std::string& what) {
  const fs::path beside = own_folder();
  std::string places;
  for (const fs::path& folder : std::array<fs::path, 3>{beside, beside / "terrazzo", TERRAZZO_MODULE_FOLDER}) {
    fs::path path = (folder / name).lexically_normal();
    if (std::error_code missing; fs::exists(path, missing)) return path;
    places += (places.empty() ? "" : ", ") + path.string();
  }
  throw Error(
      fmt::format("{} is missing; looked for {}. `cmake --install BUILD_FOLDER --prefix FOLDER` installs it with "
                  "the program",
                  what, places));
}

}  // namespace terrazzo
