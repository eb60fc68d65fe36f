#include "core/image/image_libraries.h"

#include <array>
#include <filesystem>

#include <dlfcn.h>
#include <fmt/format.h>

#include "core/base/error.h"
#include "module_folder.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

constexpr const char* module_name = "terrazzo_libraries.so";

/// The folder of the library that this code is in; that of the program if it is in none.
fs::path own_folder() {
  std::error_code unreadable;
  Dl_info place{};
  const bool is_known = ::dladdr(reinterpret_cast<const void*>(&require_image_libraries), &place) != 0;
  const fs::path file = fs::canonical(is_known ? place.dli_fname : "/proc/self/exe", unreadable);
  return file.parent_path();
}

/// Beside the library, where it is installed, or where it was built. Throws Error if it is in none of these places.
fs::path module_path() {
  const fs::path beside = own_folder();
  const std::array<fs::path, 3> folders = {beside, beside / "terrazzo", TERRAZZO_MODULE_FOLDER};
  std::string places;
  for (const fs::path& folder : folders) {
    fs::path path = (folder / module_name).lexically_normal();
    if (std::error_code missing; fs::exists(path, missing)) return path;
    places += (places.empty() ? "" : ", ") + path.string();
  }
  throw Error(
      fmt::format("the module for JPEG, TIFF and EXR files is missing; looked for {}. `cmake --install BUILD_FOLDER "
                  "--prefix FOLDER` installs it with the program",
                  places));
}

const ImageLibraries& load() {
  const fs::path path = module_path();
  const auto fail = [&] { return Error(fmt::format("cannot load {}: {}", path.string(), ::dlerror())); };
  void* module = ::dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (!module) throw fail();
  void* symbol = ::dlsym(module, "terrazzo_image_libraries");
  if (!symbol) throw fail();
  return *reinterpret_cast<const ImageLibraries* (*)()>(symbol)();
}

}  // namespace

void require_image_libraries() {
  module_path();
}

const ImageLibraries& image_libraries() {
  static const ImageLibraries& libraries = load();
  return libraries;
}

}  // namespace terrazzo
